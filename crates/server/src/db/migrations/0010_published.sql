-- Since when students see the groups that an assignment's suite hides.
ALTER TABLE assignment ADD COLUMN published_at {int};
-- What is shown of a result before: empty where nothing is hidden, nothing where nobody has looked.
ALTER TABLE result ADD COLUMN shown TEXT;
