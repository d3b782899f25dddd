// Functions for test_modules.py, which run in an empty page beside the modules of the viewer's.

import { bounded } from "/bounded.js";

export function bounds(list) {
  return list.map(bounded);
}
