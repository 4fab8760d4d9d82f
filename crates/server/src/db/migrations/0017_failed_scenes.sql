-- The scenes that a result does not accept, those of hidden groups, too: a line each, with the verdict in short. Nothing
-- for results of older versions.
ALTER TABLE result ADD COLUMN failed TEXT;
