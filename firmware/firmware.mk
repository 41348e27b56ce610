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
  --fomit-frame-pointer $(OPTIONS)

# What is in no hurry is compiled to byte code: half the size, ten times slower.
BYTE_C := $(addprefix firmware/,lathe/machine.c lathe/guard_aim.c \
  lathe/buttons.c lathe/homing.c \
  lathe/passes.c lathe/places.c lathe/progress.c lathe/cuts.c lathe/manual.c \
  lathe/part_check.c lathe/part_values.c lathe/shape_check.c lathe/stroke.c \
  reset.c link/commands.c link/lengths.c motion/set_up.c panel/led.c \
  store/eeprom_write.c store/parts.c store/settings.c panel/by_hand.c panel/keys.c panel/menu.c panel/panel.c \
  panel/screen.c)
BYTE_I := $(BYTE_C:firmware/%.c=$(OBJECTS)/%.i)
FIRMWARE_C := $(filter-out $(BYTE_C),$(wildcard firmware/*.c firmware/*/*.c))
FIRMWARE_ASM := $(wildcard firmware/*.asm firmware/*/*.asm)
FIRMWARE_H := $(wildcard firmware/*.h firmware/*/*.h)
FIRMWARE_INC := $(wildcard firmware/*/*.inc)
ASM_INCLUDES := -I firmware/bytecode -I firmware/loader -I firmware/panel
COMPILED := $(FIRMWARE_C:firmware/%.c=$(OBJECTS)/%.asm)
FIRMWARE_O := $(patsubst firmware/%.asm,$(OBJECTS)/%.o, \
  $(filter-out firmware/startup.asm,$(FIRMWARE_ASM))) \
  $(OBJECTS)/compiled.o $(OBJECTS)/byte_code.o $(OBJECTS)/sfr.o
SHRINK := $(wildcard firmware/toolchain/shrink_*.py)
BYTE_TOOLS := $(wildcard firmware/toolchain/*bytecode*.py)

.PHONY: firmware
firmware: $(FIRMWARE)/size.json ## build the firmware, print bytes per room

# The same for a board that lives on the cable, see usb_config.h; for its tests.
BUS_POWERED := build/bus-powered

.PHONY: firmware-bus-powered
firmware-bus-powered: | $(SETUP_STAMP)
	@$(MAKE) -o setup -o $(SETUP_STAMP) FIRMWARE=$(BUS_POWERED) \
	  OPTIONS="-DUSB_SELF_POWERED=0 -DUSB_BUS_CURRENT_MA=500" firmware

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

$(OBJECTS)/%.i: firmware/%.c $(FIRMWARE_H)
	@mkdir -p $(@D)
	@$(SDCC) $(SDCC_FLAGS) -E -D__code= -D__data= $< -o $@

$(OBJECTS)/byte_code.asm: $(BYTE_I) $(COMPILED) $(FIRMWARE_ASM) $(BYTE_TOOLS)
	@echo "byte code $@"
	@$(PYTHON) firmware/toolchain/compile_bytecode.py \
	  --native $(COMPILED) $(FIRMWARE_ASM) -o $@ \
	  --stack $(FIRMWARE)/byte_code.json $(BYTE_I)

$(OBJECTS)/byte_code.o: $(OBJECTS)/byte_code.asm
	@gpasm -p$(CHIP) -w2 -c $< -o $@

# All compiled modules become one, a third smaller: see shrink_assembly.py.
$(OBJECTS)/compiled.o: $(COMPILED) $(FIRMWARE_ASM) $(OBJECTS)/byte_code.asm \
  $(SHRINK)
	@echo "shrink $(@:.o=.asm)"
	@python3 firmware/toolchain/shrink_assembly.py $(FIRMWARE_ASM:%=--asm %) \
	  --asm $(OBJECTS)/byte_code.asm --entries $(FIRMWARE)/byte_code.json \
	  --report -o $(@:.o=.asm) $(COMPILED) >$(FIRMWARE)/shrink.txt
	@gpasm -p$(CHIP) -w2 -c $(@:.o=.asm) -o $@

$(OBJECTS)/%.o: firmware/%.asm $(FIRMWARE_INC) | $(SETUP_STAMP)
	@mkdir -p $(@D)
	@echo "gpasm  $<"
	@gpasm -p$(CHIP) -w2 $(ASM_INCLUDES) -c $< -o $@

# Linked twice: the head of the program holds the CRC of what the first link
# has put behind it, see seal_program.py.
LINK := gplink -q -c -m -s firmware/tornillo.lkr
SEAL := python3 firmware/toolchain/seal_program.py

$(FIRMWARE)/tornillo.hex $(FIRMWARE)/tornillo.cod $(FIRMWARE)/tornillo.map &: \
  $(FIRMWARE_O) firmware/startup.asm firmware/tornillo.lkr firmware/link/protocol.toml \
  firmware/toolchain/seal_program.py
	@echo "gplink $(FIRMWARE)/tornillo.hex"
	@$(SEAL) -o $(OBJECTS)/open/seal.inc firmware/link/protocol.toml
	@gpasm -p$(CHIP) -w2 -I $(OBJECTS)/open -c firmware/startup.asm -o $(OBJECTS)/open/startup.o
	@$(LINK) -o $(OBJECTS)/open/tornillo.hex $(OBJECTS)/open/startup.o \
	  $(FIRMWARE_O) $(SDCC_PREFIX)/lib/libsdcc.lib
	@$(SEAL) -o $(OBJECTS)/seal.inc firmware/link/protocol.toml $(OBJECTS)/open/tornillo.hex
	@gpasm -p$(CHIP) -w2 -I $(OBJECTS) -c firmware/startup.asm -o $(OBJECTS)/startup.o
	@$(LINK) -o $(FIRMWARE)/tornillo.hex $(OBJECTS)/startup.o $(FIRMWARE_O) \
	  $(SDCC_PREFIX)/lib/libsdcc.lib

$(FIRMWARE)/size.json: $(FIRMWARE)/tornillo.hex \
  firmware/toolchain/report_size.py firmware/toolchain/stack_depth.py
	python3 firmware/toolchain/report_size.py $(FIRMWARE)
