-- Equal uploads of a person to a course are kept once, and so they count once. Many people may hand in the same bytes.
DROP INDEX submission_digest;
CREATE INDEX submission_digest ON submission (digest, account) WHERE removed_at IS NULL;
DELETE FROM kept_bytes;
INSERT INTO kept_bytes (course, account, bytes)
    SELECT course, account, CAST(sum(size) AS {int}) FROM (
        SELECT assignment.course, submission.account, max(submission.size) AS size
            FROM submission JOIN assignment ON assignment.id = submission.assignment
            WHERE submission.removed_at IS NULL GROUP BY assignment.course, submission.account, submission.digest
        UNION ALL
        SELECT assignment.course, submission.account, result_file.size FROM result_file
            JOIN result ON result.id = result_file.result
            JOIN submission ON submission.id = result.submission AND submission.removed_at IS NULL
            JOIN assignment ON assignment.id = submission.assignment
    ) AS kept GROUP BY course, account;

-- Uploads whose bytes are kept.
CREATE VIEW kept_upload AS
    SELECT submission.id, assignment.course, submission.account, submission.digest
    FROM submission JOIN assignment ON assignment.id = submission.assignment WHERE submission.removed_at IS NULL;

-- only sqlite
DROP TRIGGER submission_comes;
DROP TRIGGER submission_is_given_up;
DROP TRIGGER submission_goes;
CREATE TRIGGER submission_comes AFTER INSERT ON submission WHEN NEW.removed_at IS NULL BEGIN
    INSERT INTO kept_bytes (course, account, bytes)
        SELECT course, NEW.account, NEW.size FROM assignment WHERE id = NEW.assignment
            AND NOT EXISTS (SELECT 1 FROM kept_upload AS other WHERE other.digest = NEW.digest
                AND other.account = NEW.account AND other.course = assignment.course AND other.id <> NEW.id)
        ON CONFLICT (course, account) DO UPDATE SET bytes = bytes + excluded.bytes;
END;
CREATE TRIGGER submission_is_given_up AFTER UPDATE OF removed_at ON submission
    WHEN OLD.removed_at IS NULL AND NEW.removed_at IS NOT NULL BEGIN
    UPDATE kept_bytes SET bytes = bytes - coalesce(
        (SELECT sum(result_file.size) FROM result_file JOIN result ON result.id = result_file.result
            WHERE result.submission = NEW.id), 0)
            - CASE WHEN EXISTS (SELECT 1 FROM kept_upload AS other WHERE other.digest = NEW.digest
                AND other.account = NEW.account AND other.course = kept_bytes.course) THEN 0 ELSE NEW.size END
        WHERE account = NEW.account AND course = (SELECT course FROM assignment WHERE id = NEW.assignment);
END;
CREATE TRIGGER submission_goes AFTER DELETE ON submission WHEN OLD.removed_at IS NULL BEGIN
    UPDATE kept_bytes SET bytes = bytes - OLD.size
        WHERE account = OLD.account AND course = (SELECT course FROM assignment WHERE id = OLD.assignment)
            AND NOT EXISTS (SELECT 1 FROM kept_upload AS other WHERE other.digest = OLD.digest
                AND other.account = OLD.account AND other.course = kept_bytes.course);
END;
-- end
-- only postgres
CREATE OR REPLACE FUNCTION count_submissions() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    -- Digests of which the first upload comes, or the last one goes.
    IF TG_OP = 'UPDATE' THEN
        INSERT INTO kept_bytes (course, account, bytes)
            SELECT course, account, -CAST(sum(size) AS BIGINT) FROM (
                SELECT assignment.course, changed.account, max(changed.size) AS size FROM changed
                    JOIN before ON before.id = changed.id AND before.removed_at IS NULL
                    JOIN assignment ON assignment.id = changed.assignment
                    WHERE changed.removed_at IS NOT NULL
                        AND NOT EXISTS (SELECT 1 FROM kept_upload AS other WHERE other.digest = changed.digest
                            AND other.account = changed.account AND other.course = assignment.course)
                    GROUP BY assignment.course, changed.account, changed.digest
                UNION ALL
                SELECT assignment.course, changed.account, result_file.size FROM changed
                    JOIN before ON before.id = changed.id AND before.removed_at IS NULL
                    JOIN assignment ON assignment.id = changed.assignment
                    JOIN result ON result.submission = changed.id
                    JOIN result_file ON result_file.result = result.id
                    WHERE changed.removed_at IS NOT NULL
            ) AS gone GROUP BY 1, 2 ORDER BY 1, 2
            ON CONFLICT (course, account) DO UPDATE SET bytes = kept_bytes.bytes + excluded.bytes;
    ELSE
        INSERT INTO kept_bytes (course, account, bytes)
            SELECT course, account, CAST(sum(size) AS BIGINT) * CASE WHEN TG_OP = 'INSERT' THEN 1 ELSE -1 END FROM (
                SELECT assignment.course, changed.account, max(changed.size) AS size FROM changed
                    JOIN assignment ON assignment.id = changed.assignment
                    WHERE changed.removed_at IS NULL
                        AND NOT EXISTS (SELECT 1 FROM kept_upload AS other WHERE other.digest = changed.digest
                            AND other.account = changed.account AND other.course = assignment.course
                            AND other.id NOT IN (SELECT id FROM changed))
                    GROUP BY assignment.course, changed.account, changed.digest
            ) AS moved GROUP BY 1, 2 ORDER BY 1, 2
            ON CONFLICT (course, account) DO UPDATE SET bytes = kept_bytes.bytes + excluded.bytes;
    END IF;
    RETURN NULL;
END $$;
-- end
