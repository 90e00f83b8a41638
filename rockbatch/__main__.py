"""``python -m rockbatch``."""

import sys

from rockbatch.cli import main

sys.exit(main())
