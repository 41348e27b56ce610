# SPDX-License-Identifier: Apache-2.0
"""A lathe that exists only in simulation: chip, USB cable, motors, screws and metal.

``VirtualLathe`` in ``virtual_lathe.lathe`` is everything together; ``Chip`` in
``virtual_lathe.chip`` is the processor alone. The README beside this file says what is modelled
and on which grounds.
"""
