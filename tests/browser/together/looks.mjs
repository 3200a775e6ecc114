/** What is shown and asked, and how, in one Chromium, as `small.mjs`. */
import '../axe.test.mjs';
import '../axes.test.mjs';
import '../certainty.test.mjs';
import '../seeing.test.mjs';
