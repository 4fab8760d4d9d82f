-- The parts of a grade for tables: points of groups and likely mistakes, as JSON. Nothing for results of older versions.
ALTER TABLE result ADD COLUMN parts TEXT;
-- The name of a suite, and when it was uploaded last. Nothing for those of older versions.
ALTER TABLE suite ADD COLUMN name TEXT NOT NULL DEFAULT '';
ALTER TABLE suite ADD COLUMN uploaded_at {int};
