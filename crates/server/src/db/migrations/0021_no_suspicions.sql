-- Whether the reference is wrong is no longer asked of answers that agree.
DROP TABLE wrong_scene;
DROP TABLE suspicion;
ALTER TABLE result DROP COLUMN nearly_right;
