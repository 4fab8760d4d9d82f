-- Whose an account is. One that a course's staff made is that course's until its person sets a password, comes by a
-- platform, or joins another course; until then staff may make links for it.
ALTER TABLE account ADD COLUMN managed_by {int};
-- Begun or made by a link of a course's staff, who may have used it themselves.
ALTER TABLE session ADD COLUMN vouched {int} NOT NULL DEFAULT 0;
ALTER TABLE token ADD COLUMN vouched {int} NOT NULL DEFAULT 0;
ALTER TABLE sign_in_link ADD COLUMN vouched {int} NOT NULL DEFAULT 0;
-- The token that began it, with which it ends.
ALTER TABLE session ADD COLUMN token {int};

UPDATE account SET managed_by = (SELECT min(member.course) FROM member WHERE member.account = account.id)
WHERE is_admin = 0 AND password IS NULL
    AND (SELECT count(*) FROM member WHERE member.account = account.id) = 1
    AND NOT EXISTS (SELECT 1 FROM member WHERE member.account = account.id AND member.role = 'staff')
    AND NOT EXISTS (SELECT 1 FROM platform_account WHERE platform_account.account = account.id);
UPDATE sign_in_link SET vouched = 1 WHERE created_by IN (SELECT id FROM account WHERE is_admin = 0);
UPDATE session SET vouched = 1 WHERE account IN
    (SELECT sign_in_link.account FROM sign_in_link JOIN account ON account.id = sign_in_link.account
     WHERE account.managed_by IS NOT NULL AND sign_in_link.vouched = 1 AND sign_in_link.used_at IS NOT NULL);
UPDATE token SET vouched = 1 WHERE account IN
    (SELECT sign_in_link.account FROM sign_in_link JOIN account ON account.id = sign_in_link.account
     WHERE account.managed_by IS NOT NULL AND sign_in_link.vouched = 1 AND sign_in_link.used_at IS NOT NULL);

-- Into a further course, or as its staff: nothing changes until the person accepts. Of the link's secret the digest.
CREATE TABLE invitation (
    course {int} NOT NULL REFERENCES course (id),
    account {int} NOT NULL REFERENCES account (id),
    name TEXT NOT NULL,
    role TEXT NOT NULL CHECK (role IN ('student', 'staff')),
    digest TEXT NOT NULL UNIQUE,
    invited_by {int} NOT NULL REFERENCES account (id),
    created_at {int} NOT NULL,
    PRIMARY KEY (course, account)
) {strict};
CREATE INDEX invitation_account ON invitation (account);
