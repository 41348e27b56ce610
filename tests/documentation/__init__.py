# SPDX-License-Identifier: Apache-2.0
"""The pages as a whole."""
