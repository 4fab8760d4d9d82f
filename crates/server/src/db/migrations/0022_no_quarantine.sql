-- Jobs are tried a number of times, and none runs alone.
ALTER TABLE job DROP COLUMN lone_deaths;
ALTER TABLE job DROP COLUMN is_alone;
