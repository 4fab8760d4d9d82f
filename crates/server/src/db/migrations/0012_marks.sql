-- What staff says of a submission by hand, and what its owner asks.
CREATE TABLE mark (
    submission {int} PRIMARY KEY REFERENCES submission (id),
    points TEXT,
    comment TEXT NOT NULL,
    marked_by {int} REFERENCES account (id),
    marked_at {int},
    request TEXT,
    requested_at {int}
) {strict};

-- Until when a student may hand in, where that is another moment than for the others.
CREATE TABLE extension (
    assignment {int} NOT NULL REFERENCES assignment (id),
    account {int} NOT NULL REFERENCES account (id),
    due_at {int} NOT NULL,
    set_by {int} NOT NULL REFERENCES account (id),
    set_at {int} NOT NULL,
    PRIMARY KEY (assignment, account)
) {strict};
CREATE INDEX extension_account ON extension (account);
