-- People sign in at a provider, by a learning platform, or by links.
ALTER TABLE account DROP COLUMN password;
-- Issuers of providers are here, too, behind the word "provider". A subject that joined an account in a session that a
-- link of a course's staff began.
ALTER TABLE platform_account ADD COLUMN vouched {int} NOT NULL DEFAULT 0;
