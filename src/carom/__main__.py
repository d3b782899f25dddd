"""`python -m carom` is the command line of `carom.cli.command_line`."""

import sys

from carom.cli.command_line import main

sys.exit(main())
