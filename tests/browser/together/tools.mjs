/** Every tool and the keys, in one browser, as `poses.mjs`. */
import '../keys.test.mjs';
import '../outline_tools.test.mjs';
import '../tool_keys.test.mjs';
import '../tracing.test.mjs';
