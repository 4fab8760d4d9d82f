-- Suites belong to the course that they were uploaded to: another course's staff grades by none of them.
CREATE TABLE suite (
    course {int} NOT NULL REFERENCES course (id),
    digest TEXT NOT NULL,
    PRIMARY KEY (course, digest)
) {strict};
INSERT INTO suite (course, digest)
SELECT DISTINCT course, substr(settings, {strpos}(settings, '"suite_archive":"') + 17, 64) FROM assignment
WHERE {strpos}(settings, '"suite_archive":"') > 0;
-- Counts the changes of an assignment: a page that was opened before one does not overwrite it.
ALTER TABLE assignment ADD COLUMN revision {int} NOT NULL DEFAULT 0;
