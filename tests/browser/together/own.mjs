/** What a person brings along and does by hand, in one Chromium, as `small.mjs`. */
import '../bad_input.test.mjs';
import '../hand.test.mjs';
import '../new_user.test.mjs';
import '../own_data.test.mjs';
