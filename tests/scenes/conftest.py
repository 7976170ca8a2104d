# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of the comparisons' tests."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))


def pytest_configure(config):
    config.addinivalue_line("markers", "slow: takes more than some seconds; left out by ./panoptes test --fast")
