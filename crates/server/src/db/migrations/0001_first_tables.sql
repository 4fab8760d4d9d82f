-- Times are milliseconds since 1970 by the database's clock. Points and other numbers with digits are text.

CREATE TABLE account (
    id {id},
    login TEXT NOT NULL UNIQUE,
    name TEXT NOT NULL,
    is_admin {int} NOT NULL DEFAULT 0,
    password TEXT,
    created_at {int} NOT NULL,
    disabled_at {int}
) {strict};

CREATE TABLE course (
    id {id},
    slug TEXT NOT NULL UNIQUE,
    title TEXT NOT NULL,
    created_at {int} NOT NULL,
    archived_at {int}
) {strict};

CREATE TABLE member (
    course {int} NOT NULL REFERENCES course (id),
    account {int} NOT NULL REFERENCES account (id),
    role TEXT NOT NULL CHECK (role IN ('student', 'staff')),
    created_at {int} NOT NULL,
    PRIMARY KEY (course, account)
) {strict};
CREATE INDEX member_account ON member (account);

CREATE TABLE assignment (
    id {id},
    course {int} NOT NULL REFERENCES course (id),
    slug TEXT NOT NULL,
    title TEXT NOT NULL,
    settings TEXT NOT NULL,
    visible {int} NOT NULL DEFAULT 0,
    created_at {int} NOT NULL,
    UNIQUE (course, slug)
) {strict};

-- What was handed in. The bytes lie in the store under their digest.
CREATE TABLE submission (
    id {id},
    assignment {int} NOT NULL REFERENCES assignment (id),
    account {int} NOT NULL REFERENCES account (id),
    number {int} NOT NULL,
    form TEXT NOT NULL CHECK (form IN ('program', 'sources', 'traces')),
    file_name TEXT NOT NULL,
    digest TEXT NOT NULL,
    size {int} NOT NULL,
    created_at {int} NOT NULL,
    UNIQUE (assignment, account, number)
) {strict};
CREATE INDEX submission_account ON submission (account, id);

-- A regrade: new results beside the old ones until somebody decides.
CREATE TABLE campaign (
    id {id},
    assignment {int} NOT NULL REFERENCES assignment (id),
    state TEXT NOT NULL CHECK (state IN ('open', 'applied', 'discarded')),
    reason TEXT NOT NULL,
    settings TEXT NOT NULL,
    started_by {int} NOT NULL REFERENCES account (id),
    created_at {int} NOT NULL,
    decided_by {int} REFERENCES account (id),
    decided_at {int}
) {strict};

-- The queue. A job waits, runs under a lease, and ends once: done, buried (tried too often) or cancelled.
CREATE TABLE job (
    id {id},
    lane TEXT NOT NULL,
    submission {int} REFERENCES submission (id),
    campaign {int} REFERENCES campaign (id),
    fair_key TEXT NOT NULL,
    payload TEXT NOT NULL,
    state TEXT NOT NULL CHECK (state IN ('waiting', 'running', 'done', 'buried', 'cancelled')),
    -- The place in the queue: smaller goes first. See queue::enqueue.
    rank {int} NOT NULL,
    run_after {int} NOT NULL,
    -- Counts claims and only grows: it tells a late worker from the one that holds the lease.
    attempt {int} NOT NULL DEFAULT 0,
    failures {int} NOT NULL DEFAULT 0,
    worker TEXT,
    lease_key TEXT,
    lease_until {int},
    last_fault TEXT,
    enqueued_at {int} NOT NULL,
    started_at {int},
    finished_at {int}
) {queue};
CREATE INDEX job_waiting ON job (lane, rank, id) WHERE state = 'waiting';
CREATE INDEX job_running ON job (lease_until) WHERE state = 'running';
CREATE INDEX job_fair ON job (fair_key, rank) WHERE state IN ('waiting', 'running');
CREATE INDEX job_finished ON job (lane, finished_at) WHERE state = 'done';
CREATE INDEX job_submission ON job (submission);
CREATE INDEX job_campaign ON job (campaign);

-- When somebody last looked for leases that ran out. A gap means that the database was away, not the workers.
CREATE TABLE pulse (
    id {int} PRIMARY KEY CHECK (id = 1),
    beat_at {int} NOT NULL
) {strict};
INSERT INTO pulse (id, beat_at) VALUES (1, {now});

CREATE TABLE worker (
    name TEXT PRIMARY KEY,
    version TEXT NOT NULL,
    slots {int} NOT NULL,
    started_at {int} NOT NULL,
    seen_at {int} NOT NULL
) {strict};

-- What a job came to. One row for each job, by the key: a second one can't be written.
CREATE TABLE result (
    id {id},
    job {int} NOT NULL UNIQUE REFERENCES job (id),
    submission {int} NOT NULL REFERENCES submission (id),
    campaign {int} REFERENCES campaign (id),
    attempt {int} NOT NULL,
    worker TEXT NOT NULL,
    verdict TEXT NOT NULL,
    code TEXT NOT NULL,
    points TEXT,
    max_points TEXT,
    summary TEXT NOT NULL,
    version TEXT NOT NULL,
    task TEXT NOT NULL,
    seconds TEXT NOT NULL,
    created_at {int} NOT NULL
) {strict};
CREATE INDEX result_submission ON result (submission, id);
CREATE INDEX result_campaign ON result (campaign);

CREATE TABLE result_file (
    result {int} NOT NULL REFERENCES result (id),
    name TEXT NOT NULL,
    media_type TEXT NOT NULL,
    digest TEXT NOT NULL,
    size {int} NOT NULL,
    PRIMARY KEY (result, name)
) {strict};
CREATE INDEX result_file_digest ON result_file (digest);

-- The result that counts for a submission, and how it came to count.
CREATE TABLE grade (
    submission {int} PRIMARY KEY REFERENCES submission (id),
    result {int} NOT NULL REFERENCES result (id),
    set_at {int} NOT NULL
) {strict};

CREATE TABLE grade_change (
    id {id},
    submission {int} NOT NULL REFERENCES submission (id),
    old_result {int} REFERENCES result (id),
    new_result {int} NOT NULL REFERENCES result (id),
    changed_by {int} REFERENCES account (id),
    campaign {int} REFERENCES campaign (id),
    reason TEXT NOT NULL,
    changed_at {int} NOT NULL
) {strict};
CREATE INDEX grade_change_submission ON grade_change (submission, id);

-- Everything that happened, for pages that follow along and for the audit log. Never changed, never deleted.
CREATE TABLE event (
    id {id},
    happened_at {int} NOT NULL,
    kind TEXT NOT NULL,
    actor {int} REFERENCES account (id),
    course {int},
    assignment {int},
    submission {int},
    job {int},
    text TEXT NOT NULL
) {strict};
CREATE INDEX event_submission ON event (submission, id);
CREATE INDEX event_course ON event (course, id);
CREATE INDEX event_kind ON event (kind, id);
