/** The ways from opening to a pose, in one browser: each start of Firefox takes 3.5 s of a processor (`tests/records/tests.md`). */
import '../edges.test.mjs';
import '../firefox.test.mjs';
import '../new_user.test.mjs';
