-- How far a running job is, in scenes.
ALTER TABLE job ADD COLUMN scenes_done {int};
ALTER TABLE job ADD COLUMN scenes {int};
