# Builds build/firmware/tornillo.{hex,cod,map} and size.json.
# SPDX-License-Identifier: Apache-2.0

FIRMWARE := build/firmware
OBJECTS := $(FIRMWARE)/obj
CHIP := 18f4550
GPUTILS_HEADERS := /usr/share/gputils/header

# sdcc and its library: a PIC16-capable sdcc on the PATH, else our own build.
SDCC_PREFIX := $(CACHE)/sdcc-4.2.0
SDCC := $(SDCC_PREFIX)/bin/sdcc
SDCC_FLAGS := -mpic16 -p$(CHIP) --no-warn-non-free --nostdlib --nostdinc \
  -I$(SDCC_PREFIX)/include/pic16 -I$(SDCC_PREFIX)/include -I$(FIRMWARE) \
  -Ifirmware --obanksel=9 --optimize-cmp --optimize-df --denable-peeps \
  --fomit-frame-pointer

FIRMWARE_C := $(wildcard firmware/*.c firmware/*/*.c)
FIRMWARE_ASM := $(wildcard firmware/*.asm firmware/*/*.asm)
FIRMWARE_H := $(wildcard firmware/*.h firmware/*/*.h)
COMPILED := $(FIRMWARE_C:firmware/%.c=$(OBJECTS)/%.asm)
FIRMWARE_O := $(FIRMWARE_ASM:firmware/%.asm=$(OBJECTS)/%.o) \
  $(OBJECTS)/compiled.o $(OBJECTS)/sfr.o
SHRINK := $(wildcard firmware/toolchain/shrink_*.py)

.PHONY: firmware
firmware: $(FIRMWARE)/size.json ## build the firmware, print bytes per room

$(FIRMWARE)/sfr.h $(FIRMWARE)/sfr.c &: firmware/toolchain/generate_sfr.py \
  | $(SETUP_STAMP)
	python3 $< $(GPUTILS_HEADERS)/p$(CHIP).inc $(FIRMWARE)

$(OBJECTS)/sfr.o: $(FIRMWARE)/sfr.c
	@mkdir -p $(@D)
	@$(SDCC) $(SDCC_FLAGS) -c $< -o $@

$(OBJECTS)/%.asm: firmware/%.c $(FIRMWARE_H) $(FIRMWARE)/sfr.h \
  firmware/toolchain/repair_assembly.py
	@mkdir -p $(@D)
	@echo "sdcc   $<"
	@$(SDCC) $(SDCC_FLAGS) -S $< -o $@
	@python3 firmware/toolchain/repair_assembly.py $@

# All compiled modules become one, a third smaller: see shrink_assembly.py.
$(OBJECTS)/compiled.o: $(COMPILED) $(FIRMWARE_ASM) $(SHRINK)
	@echo "shrink $(@:.o=.asm)"
	@python3 firmware/toolchain/shrink_assembly.py $(FIRMWARE_ASM:%=--asm %) \
	  --report -o $(@:.o=.asm) $(COMPILED) >$(FIRMWARE)/shrink.txt
	@gpasm -p$(CHIP) -w2 -c $(@:.o=.asm) -o $@

$(OBJECTS)/%.o: firmware/%.asm | $(SETUP_STAMP)
	@mkdir -p $(@D)
	@echo "gpasm  $<"
	@gpasm -p$(CHIP) -w2 -c $< -o $@

$(FIRMWARE)/tornillo.hex $(FIRMWARE)/tornillo.cod $(FIRMWARE)/tornillo.map &: \
  $(FIRMWARE_O) firmware/tornillo.lkr
	@echo "gplink $(FIRMWARE)/tornillo.hex"
	@gplink -q -c -m -s firmware/tornillo.lkr -o $(FIRMWARE)/tornillo.hex \
	  $(FIRMWARE_O) $(SDCC_PREFIX)/lib/libsdcc.lib

$(FIRMWARE)/size.json: $(FIRMWARE)/tornillo.hex \
  firmware/toolchain/report_size.py firmware/toolchain/stack_depth.py
	python3 firmware/toolchain/report_size.py $(FIRMWARE)
