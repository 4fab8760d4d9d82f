-- Removing a row asks who refers to it.
CREATE INDEX upload_key_submission ON upload_key (submission);
CREATE INDEX grade_result ON grade (result);
CREATE INDEX grade_change_old ON grade_change (old_result);
CREATE INDEX grade_change_new ON grade_change (new_result);
CREATE INDEX platform_score_account ON platform_score (account);
