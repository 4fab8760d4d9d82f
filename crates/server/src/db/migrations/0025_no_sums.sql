-- What only grows is counted by its numbers and indexes.
DROP TABLE tally;
