-- Secrets of the service itself, the same for all its servers: what it signs and looks at again needs no row.
CREATE TABLE server_secret (
    name TEXT PRIMARY KEY,
    value TEXT NOT NULL
) {strict};
-- Sign-ins from learning platforms that were used. Those that are only begun are signed, and stand nowhere.
DROP TABLE platform_login;
CREATE TABLE platform_login (
    state TEXT PRIMARY KEY,
    expires_at {int} NOT NULL
) {strict};
