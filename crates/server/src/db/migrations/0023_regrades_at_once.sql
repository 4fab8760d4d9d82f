-- Each step of a regrade is one transaction.
DROP INDEX campaign_doing;
ALTER TABLE campaign DROP COLUMN doing;
ALTER TABLE campaign DROP COLUMN cursor;
ALTER TABLE campaign DROP COLUMN done;
ALTER TABLE campaign DROP COLUMN total;
ALTER TABLE campaign DROP COLUMN settings_before;
