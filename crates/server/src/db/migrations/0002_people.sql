-- Who is who. Of secrets only digests are kept: whoever reads this database can't sign in with what is in it.

CREATE TABLE session (
    digest TEXT PRIMARY KEY,
    account {int} NOT NULL REFERENCES account (id),
    created_at {int} NOT NULL,
    seen_at {int} NOT NULL,
    expires_at {int} NOT NULL
) {strict};
CREATE INDEX session_account ON session (account);

-- A token belongs to a person, or to a worker, which is nobody.
CREATE TABLE token (
    id {id},
    account {int} REFERENCES account (id),
    name TEXT NOT NULL,
    digest TEXT NOT NULL UNIQUE,
    created_by {int} REFERENCES account (id),
    created_at {int} NOT NULL,
    revoked_at {int}
) {strict};
CREATE INDEX token_account ON token (account);

-- A link that signs in once.
CREATE TABLE sign_in_link (
    digest TEXT PRIMARY KEY,
    account {int} NOT NULL REFERENCES account (id),
    created_by {int} REFERENCES account (id),
    created_at {int} NOT NULL,
    expires_at {int} NOT NULL,
    used_at {int}
) {strict};
CREATE INDEX sign_in_link_account ON sign_in_link (account);

-- What an upload was called by whoever sent it: sent twice, it is one submission.
CREATE TABLE upload_key (
    account {int} NOT NULL REFERENCES account (id),
    word TEXT NOT NULL,
    assignment {int} NOT NULL REFERENCES assignment (id),
    digest TEXT NOT NULL,
    submission {int} NOT NULL REFERENCES submission (id),
    PRIMARY KEY (account, word)
) {strict};

-- What a worker stored for a job that it holds: of anything else it may not say that it belongs to the result.
CREATE TABLE job_file (
    job {int} NOT NULL REFERENCES job (id),
    attempt {int} NOT NULL,
    digest TEXT NOT NULL,
    size {int} NOT NULL,
    PRIMARY KEY (job, attempt, digest)
) {strict};

CREATE INDEX event_assignment ON event (assignment, id);
CREATE INDEX campaign_assignment ON campaign (assignment, id);
