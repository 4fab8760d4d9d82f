-- A worker that dies is no failure of the job that it ran: it is counted by itself, and apart while the job ran alone.
ALTER TABLE job ADD COLUMN deaths {int} NOT NULL DEFAULT 0;
ALTER TABLE job ADD COLUMN lone_deaths {int} NOT NULL DEFAULT 0;
-- Whether nothing else runs beside it in its worker.
ALTER TABLE job ADD COLUMN is_alone {int} NOT NULL DEFAULT 0;
-- The token of the worker that holds it, where it came by one.
ALTER TABLE job ADD COLUMN token {int};
-- Whether a later job grades its submission again.
ALTER TABLE job ADD COLUMN replaced {int} NOT NULL DEFAULT 0;
CREATE INDEX job_token ON job (token) WHERE state = 'running';

-- What went wrong with a worker last, how often, and how often since it last brought a result; since when it takes no
-- jobs because it can't grade.
ALTER TABLE worker ADD COLUMN token {int};
ALTER TABLE worker ADD COLUMN fault TEXT;
ALTER TABLE worker ADD COLUMN fault_at {int};
ALTER TABLE worker ADD COLUMN faults {int} NOT NULL DEFAULT 0;
ALTER TABLE worker ADD COLUMN in_a_row {int} NOT NULL DEFAULT 0;
ALTER TABLE worker ADD COLUMN aside_since {int};

-- Since when an assignment's jobs wait for staff, because none of its submissions can be graded, and why.
ALTER TABLE assignment ADD COLUMN paused_at {int};
ALTER TABLE assignment ADD COLUMN paused_fault TEXT;

-- What a grader said of its machine is staff's to read, in the job.
UPDATE result SET summary = 'the grader failed, which is no fault of the submission; the course''s staff is told'
    WHERE code = 'JE';

-- Counts for pages and monitors read these and not the whole queue.
CREATE INDEX job_buried ON job (lane, replaced) WHERE state = 'buried';
CREATE INDEX job_cancelled ON job (lane) WHERE state = 'cancelled';
CREATE INDEX job_oldest ON job (lane, enqueued_at) WHERE state = 'waiting' AND campaign IS NULL;

-- How many there were up to a row of tables that only grow: only what is newer has to be counted.
CREATE TABLE tally (
    name TEXT PRIMARY KEY,
    upto {int} NOT NULL,
    n {int} NOT NULL
) {strict};
INSERT INTO tally (name, upto, n) SELECT 'graded', coalesce(max(id), 0), count(*) FROM event WHERE kind = 'graded';
INSERT INTO tally (name, upto, n)
    SELECT 'failed try', coalesce(max(id), 0), count(*) FROM event WHERE kind = 'failed try';
INSERT INTO tally (name, upto, n)
    SELECT 'late answer', coalesce(max(id), 0), count(*) FROM event WHERE kind = 'late answer';
INSERT INTO tally (name, upto, n) SELECT 'buried', coalesce(max(id), 0), count(*) FROM event WHERE kind = 'buried';
INSERT INTO tally (name, upto, n) SELECT 'submission', coalesce(max(id), 0), count(*) FROM submission;
INSERT INTO tally (name, upto, n) SELECT 'result', coalesce(max(id), 0), count(*) FROM result WHERE code <> 'JE';

-- What is being done for a regrade: begin, apply or discard; up to which row, and how much of how much.
ALTER TABLE campaign ADD COLUMN doing TEXT;
ALTER TABLE campaign ADD COLUMN cursor {int} NOT NULL DEFAULT 0;
ALTER TABLE campaign ADD COLUMN done {int} NOT NULL DEFAULT 0;
ALTER TABLE campaign ADD COLUMN total {int} NOT NULL DEFAULT 0;
CREATE INDEX campaign_doing ON campaign (id) WHERE doing IS NOT NULL;
-- A regrade goes through its rows in order, and counts its jobs.
DROP INDEX result_campaign;
CREATE INDEX result_campaign ON result (campaign, id) WHERE campaign IS NOT NULL;
DROP INDEX job_campaign;
CREATE INDEX job_campaign ON job (campaign, state) WHERE campaign IS NOT NULL;
