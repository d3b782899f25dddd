"""`python -m carom` is the command line of `carom.cli`."""

import sys

from carom.cli import main

sys.exit(main())
