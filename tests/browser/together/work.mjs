/** Work as it is kept, brought in and taken out, in one Chromium, as `small.mjs`. */
import '../accessibility.test.mjs';
import '../exchange.test.mjs';
import '../frames.test.mjs';
import '../long_film.test.mjs';
import '../saving.test.mjs';
