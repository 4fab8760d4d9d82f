-- Nothing waits for staff any more: what can't be graded is tried, and then a judge error.
UPDATE job SET lane = 'grading' WHERE lane = 'paused';
ALTER TABLE assignment DROP COLUMN paused_at;
ALTER TABLE assignment DROP COLUMN paused_fault;
