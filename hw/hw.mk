# The board: schematic, layout, simulation.
# SPDX-License-Identifier: CERN-OHL-P-2.0

HW_OUT := build/hw
HW_PYTHON := /usr/bin/python3

.PHONY: hw hw-install hw-check hw-export hw-plots hw-layout

hw: hw-check hw-export ## check the board, then write PDF, BOM, gerbers, STEP, pictures

hw-install: ## install KiCad 9 and ngspice where they are missing
	@hw/install.sh

hw-check: hw-install ## rebuild and compare, ERC, DRC, nets, spice benches
	@$(HW_PYTHON) hw/checks/gate.py .

hw-export: hw-install ## write the board's documents and production files to build/hw/
	@$(HW_PYTHON) hw/export/export.py $(HW_OUT)

hw-plots: hw-install ## run the spice benches and draw docs/board/*.svg again
	@$(HW_PYTHON) hw/spice/run.py --plots docs/board

hw-layout: hw-install ## draw schematic and board again from the scripts
	@hw/kicad/layout.sh
