-- The groups of an uploaded suite, as JSON. Nothing for suites that older versions received.
ALTER TABLE suite ADD COLUMN parts TEXT;
