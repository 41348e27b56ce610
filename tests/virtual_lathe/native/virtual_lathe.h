/* SPDX-License-Identifier: Apache-2.0 */
/* The C interface of the virtual lathe: a PIC18F4550 in gpsim, the world its
 * pins and its USB port are connected to, and instruments on everything.
 *
 * There is one chip per process, because gpsim keeps its state in globals.
 * Call vl_load() once, then the parts you want (pins are always there), then
 * vl_run().  All times are instruction cycles of the 48 MHz core since the
 * first power-on, 12 to the microsecond; a change made by an instruction is
 * stamped with the cycle in which that instruction began.  Functions that
 * return int give 0 on success and -1 on failure unless stated otherwise.
 * Nothing here may be called from two threads.
 */
#ifndef VIRTUAL_LATHE_H
#define VIRTUAL_LATHE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Chip: chip.cc, chip_api.cc ---------------------------------------- */

enum vl_stop {
    VL_STOP_CYCLE = 0,      /* the wanted cycle was reached */
    VL_STOP_ADDRESS = 1,    /* the next instruction has a break on it */
    VL_STOP_EVENT = 2,      /* something waited for has happened */
    VL_STOP_LOST = 3,       /* the program counter left the program memory */
    VL_STOP_HALT = 4        /* gpsim itself asked to halt */
};

/* Loads firmware: a .hex file (taken as PIC18F4550) or a .cod file. */
int vl_load(const char *path);
/* Runs until cycle `until`; returns the enum vl_stop reason. */
int vl_run(uint64_t until);
uint64_t vl_cycle(void);
/* Byte address of the next instruction. */
unsigned vl_program_counter(void);

/* Data memory, 0x000..0xFFF.  peek and poke have no side effects on flags;
 * read and write act like an instruction of the firmware. */
unsigned vl_peek(unsigned address);
void vl_poke(unsigned address, unsigned value);
unsigned vl_read(unsigned address);
void vl_write(unsigned address, unsigned value);

/* Stops vl_run() before the instruction at a byte address. */
void vl_set_break(unsigned address, int enabled);

enum vl_reset {
    VL_RESET_POWER_ON = 0, VL_RESET_BROWN_OUT = 1, VL_RESET_WATCHDOG = 2,
    VL_RESET_MCLR = 3, VL_RESET_STACK_FULL = 4, VL_RESET_STACK_EMPTY = 5,
    VL_RESET_SOFTWARE = 6, VL_RESET_OTHER = 7
};
/* Injects a reset of one of the first four kinds between two instructions.
 * RAM keeps its contents, as on the chip after a short interruption; use
 * vl_fill_ram() first for a real power cycle. */
int vl_reset_chip(int kind);
void vl_fill_ram(unsigned seed);
/* Resets seen so far: returns how many; fills up to `room` entries. */
int vl_resets(uint64_t *cycles, int *kinds, int room);

/* Non-volatile memory: 32768 bytes of flash, 256 bytes of EEPROM, 14 bytes
 * of configuration words (0x300000..0x30000D). */
void vl_flash_read(unsigned address, uint8_t *bytes, unsigned count);
void vl_flash_write(unsigned address, const uint8_t *bytes, unsigned count);
void vl_eeprom_read(uint8_t bytes[256]);
void vl_eeprom_write(const uint8_t bytes[256]);
/* What has been written so far; broken_unlocks counts settings of WR without
 * the sequence 55, AA directly before, which the chip ignores. */
struct vl_nonvolatile_counts {
    uint32_t eeprom_writes, flash_erases, flash_writes, broken_unlocks;
};
void vl_nonvolatile_counts(struct vl_nonvolatile_counts *counts);
void vl_config_read(uint8_t bytes[14]);

/* Instruments.  `priority` is 0 for low, 1 for high; times run from the
 * acceptance of the interrupt to the end of its retfie and leave out
 * interrupts nested inside. */
struct vl_interrupt_cost {
    uint64_t entries, total, best, worst, worst_at;
};
void vl_interrupts(int priority, struct vl_interrupt_cost *cost);
unsigned vl_stack_depth_max(void);
/* One byte per program word (16384), 1 = executed. */
void vl_executed(uint8_t flags[16384]);
void vl_clear_statistics(void);

/* Records every firmware write to data memory first..last in a log of at
 * most 4096 entries; returns the number of entries so far. */
int vl_watch_writes(unsigned first, unsigned last);
struct vl_ram_write { uint64_t cycle; uint32_t address, value, pc; };
int vl_ram_writes(struct vl_ram_write *entries, int room);

/* ---- Pins: pins.cc ------------------------------------------------------ */

/* Pins are numbered port * 8 + bit, port 0 = A .. 4 = E: RB4 is 12. */
enum vl_drive {
    VL_LOW = 0,     /* connected to ground */
    VL_HIGH = 1,    /* connected to +5 V */
    VL_OPEN = 2     /* not connected: the chip's pull-up decides, if it is on */
};
int vl_pin_drive(int pin, int drive);
/* Connects the pin to `volts` through `ohms` (analogue inputs). */
int vl_pin_drive_volts(int pin, double volts, double ohms);
int vl_pin_level(int pin);
/* Levels of all pins, bit = pin number. */
uint64_t vl_pin_levels(void);
/* Logs changes of the pins in `mask` from now on, forgetting older ones. */
void vl_pin_log(uint64_t mask);
struct vl_pin_change { uint64_t cycle; uint64_t levels; };
/* Copies the oldest entries and removes them; returns how many. */
int vl_pin_changes(struct vl_pin_change *entries, int room);

/* ---- Trace: trace.cc ---------------------------------------------------- */

/* Value change dump of all pins; timescale 1 ns. */
int vl_vcd_open(const char *path);
void vl_vcd_close(void);

#ifdef __cplusplus
}
#endif
#endif
