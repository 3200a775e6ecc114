/** What page and command find alike, in one Chromium, as `small.mjs`. */
import '../shuttered.test.mjs';
import '../from_nothing.test.mjs';
