-- What a result rests on, so that it can be made again, and what submissions answer where they are not right.

ALTER TABLE result ADD COLUMN grader TEXT NOT NULL DEFAULT '';
ALTER TABLE result ADD COLUMN essence TEXT NOT NULL DEFAULT '';
-- Accepted, or wrong in few scenes: of others nobody asks whether the reference is wrong.
ALTER TABLE result ADD COLUMN nearly_right {int} NOT NULL DEFAULT 0;

-- Where a result that is nearly right is not, and the digest of what the submission answers there.
CREATE TABLE wrong_scene (
    result {int} NOT NULL REFERENCES result (id),
    scene TEXT NOT NULL,
    answer TEXT NOT NULL,
    PRIMARY KEY (result, scene)
) {strict};

-- Many who are otherwise right answer the same in a scene, and not what the reference does.
CREATE TABLE suspicion (
    id {id},
    assignment {int} NOT NULL REFERENCES assignment (id),
    scene TEXT NOT NULL,
    answer TEXT NOT NULL,
    agreeing {int} NOT NULL,
    nearly_right {int} NOT NULL,
    state TEXT NOT NULL CHECK (state IN ('open', 'dismissed', 'told')),
    found_at {int} NOT NULL,
    decided_by {int} REFERENCES account (id),
    decided_at {int},
    UNIQUE (assignment, scene, answer)
) {strict};

-- When the bytes of an old submission and its reports were given up; its grade and history stay.
ALTER TABLE submission ADD COLUMN removed_at {int};
