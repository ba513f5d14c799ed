"""``python -m dwell``."""

from dwell.cli import main

raise SystemExit(main())
