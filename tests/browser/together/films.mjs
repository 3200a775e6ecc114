/** Films that are followed, in one Chromium, as `small.mjs`: the first keeps what is published of by the second. */
import '../following.test.mjs';
import '../publishing.test.mjs';
import '../by_keys.test.mjs';
