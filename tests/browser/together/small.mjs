/** What is short, in one Chromium: each start of it and of its driver takes 0.7 s of a processor (`tests/records/tests.md`). */
import '../calibrate.test.mjs';
import '../formats.test.mjs';
import '../hostile_names.test.mjs';
import '../joint.test.mjs';
import '../loading.test.mjs';
import '../offline.test.mjs';
import '../policy.test.mjs';
import '../working.test.mjs';
