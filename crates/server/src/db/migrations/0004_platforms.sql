-- Learning platforms (LTI 1.3): who comes from where, and where scores go.

CREATE TABLE platform (
    id {id},
    name TEXT NOT NULL UNIQUE,
    issuer TEXT NOT NULL,
    client TEXT NOT NULL,
    -- Addresses and deployments, as JSON.
    settings TEXT NOT NULL,
    created_at {int} NOT NULL,
    disabled_at {int},
    UNIQUE (issuer, client)
) {strict};

-- The service's own keys, by which platforms know it. The newest sign; older ones are still told of for a while.
CREATE TABLE platform_key (
    id {id},
    kid TEXT NOT NULL UNIQUE,
    private_key TEXT NOT NULL,
    modulus TEXT NOT NULL,
    exponent TEXT NOT NULL,
    created_at {int} NOT NULL,
    retired_at {int}
) {strict};

-- A sign-in that a platform was asked for: answered once, by the same browser, and soon. All three are digests.
CREATE TABLE platform_login (
    state TEXT PRIMARY KEY,
    nonce TEXT NOT NULL,
    browser TEXT NOT NULL,
    platform {int} NOT NULL REFERENCES platform (id),
    expires_at {int} NOT NULL
) {strict};

-- Who an issuer's subject is here.
CREATE TABLE platform_account (
    issuer TEXT NOT NULL,
    subject TEXT NOT NULL,
    account {int} NOT NULL REFERENCES account (id),
    created_at {int} NOT NULL,
    PRIMARY KEY (issuer, subject)
) {strict};
CREATE INDEX platform_account_account ON platform_account (account);

-- A course of a platform, and which course it is here.
CREATE TABLE platform_course (
    id {id},
    platform {int} NOT NULL REFERENCES platform (id),
    deployment TEXT NOT NULL,
    context TEXT NOT NULL,
    title TEXT NOT NULL,
    course {int} NOT NULL REFERENCES course (id),
    -- Where the platform tells who is in its course.
    memberships TEXT,
    created_at {int} NOT NULL,
    UNIQUE (platform, deployment, context)
) {strict};
CREATE INDEX platform_course_course ON platform_course (course);

-- Who is known to be in it.
CREATE TABLE platform_member (
    platform_course {int} NOT NULL REFERENCES platform_course (id),
    account {int} NOT NULL REFERENCES account (id),
    PRIMARY KEY (platform_course, account)
) {strict};
CREATE INDEX platform_member_account ON platform_member (account);

-- A link in it that leads to an assignment, and the column of its grade book.
CREATE TABLE platform_link (
    id {id},
    platform_course {int} NOT NULL REFERENCES platform_course (id),
    resource TEXT NOT NULL,
    assignment {int} NOT NULL REFERENCES assignment (id),
    line_item TEXT,
    line_items TEXT,
    created_at {int} NOT NULL,
    UNIQUE (platform_course, resource)
) {strict};
CREATE INDEX platform_link_assignment ON platform_link (assignment);

-- What staff who came by a link has still to choose. Kept by digest, for whom it is.
CREATE TABLE platform_choice (
    digest TEXT PRIMARY KEY,
    account {int} NOT NULL REFERENCES account (id),
    platform {int} NOT NULL REFERENCES platform (id),
    arrival TEXT NOT NULL,
    expires_at {int} NOT NULL
) {strict};

-- What a platform was told last of somebody's work, and when that became so: a platform keeps what is newer.
CREATE TABLE platform_score (
    link {int} NOT NULL REFERENCES platform_link (id),
    account {int} NOT NULL REFERENCES account (id),
    content TEXT NOT NULL,
    stamp {int} NOT NULL,
    sent_at {int},
    fault TEXT,
    PRIMARY KEY (link, account)
) {strict};

-- The platform that made somebody a member; nothing where staff did, whose word stands.
ALTER TABLE member ADD COLUMN platform {int};
