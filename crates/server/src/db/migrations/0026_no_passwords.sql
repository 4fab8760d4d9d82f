-- People sign in by links, tokens, and from learning platforms.
ALTER TABLE account DROP COLUMN password;
