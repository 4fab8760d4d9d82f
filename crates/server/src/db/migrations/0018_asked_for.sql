-- The person who had a submission graded again.
ALTER TABLE job ADD COLUMN asked_by {int} REFERENCES account (id);
-- Points by hand since a change of the grade; nothing where the grader's count. Such a change keeps the result.
ALTER TABLE grade_change ADD COLUMN given TEXT;
INSERT INTO grade_change (submission, old_result, new_result, changed_by, reason, changed_at, given)
SELECT mark.submission, grade.result, grade.result, mark.marked_by, 'points by hand: ' || mark.comment, mark.marked_at,
    mark.points
FROM mark JOIN grade ON grade.submission = mark.submission WHERE mark.points IS NOT NULL;
-- The last number that a submission of somebody to an assignment was given: removed ones keep theirs.
CREATE TABLE numbering (
    assignment {int} NOT NULL REFERENCES assignment (id),
    account {int} NOT NULL REFERENCES account (id),
    last {int} NOT NULL,
    PRIMARY KEY (assignment, account)
) {strict};
CREATE INDEX numbering_account ON numbering (account);
INSERT INTO numbering (assignment, account, last)
SELECT assignment, account, max(number) FROM submission GROUP BY assignment, account;
