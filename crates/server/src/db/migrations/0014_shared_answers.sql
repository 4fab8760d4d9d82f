-- Whether several results have the same answer is asked whenever one is nearly right.
CREATE INDEX wrong_scene_answer ON wrong_scene (scene, answer);
