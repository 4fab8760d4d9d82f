-- Who has an account of their own is added, and no longer invited.
DROP TABLE invitation;
