# SPDX-License-Identifier: Apache-2.0
"""``python -m virtual_lathe``: a lathe that runs until it is interrupted."""

import sys

from .command import main

if __name__ == "__main__":
    sys.exit(main())
