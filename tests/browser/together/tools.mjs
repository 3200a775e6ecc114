/** The way to a pose, every tool and the keys, in one browser: each start of Firefox takes 3.5 s of a processor (`tests/records/tests.md`). */
import '../edges.test.mjs';
import '../keys.test.mjs';
import '../outline_tools.test.mjs';
import '../tool_keys.test.mjs';
import '../tracing.test.mjs';
