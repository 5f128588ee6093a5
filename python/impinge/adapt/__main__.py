"""``python -m impinge.adapt``: the command ``impinge-adapt``."""

import sys

from .cli import main

sys.exit(main())
