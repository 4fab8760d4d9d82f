-- Suites have versions. What names none was set up, and graded, with the first one: it goes on with it, and results say so.
UPDATE assignment SET settings = replace(settings, '"suite":"t2m2"', '"suite":"t2m2@1"');
UPDATE assignment SET settings = replace(settings, '"suite":"earlier"', '"suite":"earlier@1"');
UPDATE assignment SET settings = replace(settings, '"suite":""', '"suite":"t2m2@1"');
UPDATE campaign SET settings = replace(settings, '"suite":"t2m2"', '"suite":"t2m2@1"');
UPDATE campaign SET settings = replace(settings, '"suite":"earlier"', '"suite":"earlier@1"');
UPDATE campaign SET settings = replace(settings, '"suite":""', '"suite":"t2m2@1"');
UPDATE result SET task = replace(task, '"named":"t2m2"', '"named":"t2m2@1"');
UPDATE result SET task = replace(task, '"named":"earlier"', '"named":"earlier@1"');
UPDATE result SET task = replace(task, '"named":""', '"named":"t2m2@1"');
