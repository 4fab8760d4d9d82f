-- The settings that an assignment had before a regrade was applied: it may be taken back while it is.
ALTER TABLE campaign ADD COLUMN settings_before TEXT;
