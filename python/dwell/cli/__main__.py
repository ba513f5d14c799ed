"""``python -m dwell.cli``."""

from dwell.cli import main

raise SystemExit(main())
