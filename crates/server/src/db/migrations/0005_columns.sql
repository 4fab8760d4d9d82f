-- While somebody has a platform make the column of a link, others wait: a grade book is to have one for it.
ALTER TABLE platform_link ADD COLUMN making_until {int};
