-- How many bytes of uploads and reports are kept, by course and person. Triggers count, so that it is exact whoever
-- writes, removes or deletes: on PostgreSQL once for each statement, since it keeps every version of a row that a
-- transaction changes often.
CREATE TABLE kept_bytes (
    course {int} NOT NULL,
    account {int} NOT NULL,
    bytes {int} NOT NULL,
    PRIMARY KEY (course, account)
) {strict};
CREATE INDEX kept_bytes_account ON kept_bytes (account);
INSERT INTO kept_bytes (course, account, bytes)
    SELECT assignment.course, submission.account, CAST(sum(submission.size + coalesce(
        (SELECT sum(result_file.size) FROM result_file JOIN result ON result.id = result_file.result
            WHERE result.submission = submission.id), 0)) AS {int})
    FROM submission JOIN assignment ON assignment.id = submission.assignment
    WHERE submission.removed_at IS NULL GROUP BY assignment.course, submission.account;

-- only sqlite
CREATE TRIGGER submission_comes AFTER INSERT ON submission WHEN NEW.removed_at IS NULL BEGIN
    INSERT INTO kept_bytes (course, account, bytes)
        SELECT course, NEW.account, NEW.size FROM assignment WHERE id = NEW.assignment
        ON CONFLICT (course, account) DO UPDATE SET bytes = bytes + excluded.bytes;
END;
CREATE TRIGGER submission_is_given_up AFTER UPDATE OF removed_at ON submission
    WHEN OLD.removed_at IS NULL AND NEW.removed_at IS NOT NULL BEGIN
    UPDATE kept_bytes SET bytes = bytes - NEW.size - coalesce(
        (SELECT sum(result_file.size) FROM result_file JOIN result ON result.id = result_file.result
            WHERE result.submission = NEW.id), 0)
        WHERE account = NEW.account AND course = (SELECT course FROM assignment WHERE id = NEW.assignment);
END;
CREATE TRIGGER submission_goes AFTER DELETE ON submission WHEN OLD.removed_at IS NULL BEGIN
    UPDATE kept_bytes SET bytes = bytes - OLD.size
        WHERE account = OLD.account AND course = (SELECT course FROM assignment WHERE id = OLD.assignment);
END;
CREATE TRIGGER report_comes AFTER INSERT ON result_file BEGIN
    INSERT INTO kept_bytes (course, account, bytes)
        SELECT assignment.course, submission.account, NEW.size FROM result
            JOIN submission ON submission.id = result.submission AND submission.removed_at IS NULL
            JOIN assignment ON assignment.id = submission.assignment
            WHERE result.id = NEW.result
        ON CONFLICT (course, account) DO UPDATE SET bytes = bytes + excluded.bytes;
END;
CREATE TRIGGER report_goes AFTER DELETE ON result_file BEGIN
    INSERT INTO kept_bytes (course, account, bytes)
        SELECT assignment.course, submission.account, -OLD.size FROM result
            JOIN submission ON submission.id = result.submission AND submission.removed_at IS NULL
            JOIN assignment ON assignment.id = submission.assignment
            WHERE result.id = OLD.result
        ON CONFLICT (course, account) DO UPDATE SET bytes = bytes + excluded.bytes;
END;
-- end
-- only postgres
CREATE FUNCTION count_submissions() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    IF TG_OP = 'INSERT' THEN
        INSERT INTO kept_bytes (course, account, bytes)
            SELECT assignment.course, changed.account, CAST(sum(changed.size) AS BIGINT) FROM changed
                JOIN assignment ON assignment.id = changed.assignment
                WHERE changed.removed_at IS NULL GROUP BY 1, 2 ORDER BY 1, 2
            ON CONFLICT (course, account) DO UPDATE SET bytes = kept_bytes.bytes + excluded.bytes;
    ELSIF TG_OP = 'DELETE' THEN
        INSERT INTO kept_bytes (course, account, bytes)
            SELECT assignment.course, changed.account, -CAST(sum(changed.size) AS BIGINT) FROM changed
                JOIN assignment ON assignment.id = changed.assignment
                WHERE changed.removed_at IS NULL GROUP BY 1, 2 ORDER BY 1, 2
            ON CONFLICT (course, account) DO UPDATE SET bytes = kept_bytes.bytes + excluded.bytes;
    ELSE
        INSERT INTO kept_bytes (course, account, bytes)
            SELECT assignment.course, changed.account, -CAST(sum(changed.size + coalesce(
                (SELECT sum(result_file.size) FROM result_file JOIN result ON result.id = result_file.result
                    WHERE result.submission = changed.id), 0)) AS BIGINT) FROM changed
                JOIN before ON before.id = changed.id AND before.removed_at IS NULL
                JOIN assignment ON assignment.id = changed.assignment
                WHERE changed.removed_at IS NOT NULL GROUP BY 1, 2 ORDER BY 1, 2
            ON CONFLICT (course, account) DO UPDATE SET bytes = kept_bytes.bytes + excluded.bytes;
    END IF;
    RETURN NULL;
END $$;
CREATE FUNCTION count_reports() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    INSERT INTO kept_bytes (course, account, bytes)
        SELECT assignment.course, submission.account,
            CAST(sum(changed.size) AS BIGINT) * CASE WHEN TG_OP = 'DELETE' THEN -1 ELSE 1 END FROM changed
            JOIN result ON result.id = changed.result
            JOIN submission ON submission.id = result.submission AND submission.removed_at IS NULL
            JOIN assignment ON assignment.id = submission.assignment
            GROUP BY 1, 2 ORDER BY 1, 2
        ON CONFLICT (course, account) DO UPDATE SET bytes = kept_bytes.bytes + excluded.bytes;
    RETURN NULL;
END $$;
CREATE TRIGGER submission_comes AFTER INSERT ON submission REFERENCING NEW TABLE AS changed
    FOR EACH STATEMENT EXECUTE FUNCTION count_submissions();
CREATE TRIGGER submission_is_given_up AFTER UPDATE ON submission REFERENCING OLD TABLE AS before NEW TABLE AS changed
    FOR EACH STATEMENT EXECUTE FUNCTION count_submissions();
CREATE TRIGGER submission_goes AFTER DELETE ON submission REFERENCING OLD TABLE AS changed
    FOR EACH STATEMENT EXECUTE FUNCTION count_submissions();
CREATE TRIGGER report_comes AFTER INSERT ON result_file REFERENCING NEW TABLE AS changed
    FOR EACH STATEMENT EXECUTE FUNCTION count_reports();
CREATE TRIGGER report_goes AFTER DELETE ON result_file REFERENCING OLD TABLE AS changed
    FOR EACH STATEMENT EXECUTE FUNCTION count_reports();
-- end

-- Retention finds what is too old, and asks of each artefact whether something names it.
CREATE INDEX submission_age ON submission (created_at, id) WHERE removed_at IS NULL;
CREATE INDEX submission_digest ON submission (digest) WHERE removed_at IS NULL;
CREATE INDEX job_file_digest ON job_file (digest);
-- The archive of a suite, within a task.
CREATE INDEX result_archive ON result (substr(task, {strpos}(task, '"archive":"') + 11, 64))
    WHERE {strpos}(task, '"archive":"') > 0;
-- Whoever reads all submissions to an assignment reads them in pages.
CREATE INDEX submission_assignment ON submission (assignment, id);
