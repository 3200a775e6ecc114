/** The ways from opening to a pose, in one Firefox: each start of it takes 3.5 s of a processor (`tests/records/tests.md`). */
import '../edges.test.mjs';
import '../firefox.test.mjs';
import '../new_user.test.mjs';
