-- The worker of a job's last failed try: another one gets it first.
ALTER TABLE job ADD COLUMN failed_by TEXT;
