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
    VL_STOP_CYCLE = 0,   /* the wanted cycle was reached */
    VL_STOP_ADDRESS = 1, /* the next instruction has a break on it */
    VL_STOP_EVENT = 2,   /* something waited for has happened */
    VL_STOP_LOST = 3,    /* the program counter left the program memory */
    VL_STOP_HALT = 4     /* gpsim itself asked to halt */
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
    VL_RESET_POWER_ON = 0,
    VL_RESET_BROWN_OUT = 1,
    VL_RESET_WATCHDOG = 2,
    VL_RESET_MCLR = 3,
    VL_RESET_STACK_FULL = 4,
    VL_RESET_STACK_EMPTY = 5,
    VL_RESET_SOFTWARE = 6,
    VL_RESET_OTHER = 7
};
/* Injects a reset of one of the first four kinds between two instructions.
 * RAM keeps its contents, as on the chip after a short interruption; use
 * vl_fill_ram() first for a real power cycle. */
int vl_reset_chip(int kind);
void vl_fill_ram(unsigned seed);
/* Resets seen so far: returns how many; fills up to `room` entries. */
int vl_resets(uint64_t *cycles, int *kinds, int room);

/* Non-volatile memory: 32768 bytes of flash, 256 bytes of EEPROM. */
void vl_flash_read(unsigned address, uint8_t *bytes, unsigned count);
void vl_flash_write(unsigned address, const uint8_t *bytes, unsigned count);
void vl_eeprom_read(uint8_t bytes[256]);
void vl_eeprom_write(const uint8_t bytes[256]);
/* CONFIG6L and CONFIG6H, which gpsim does not keep: blocks that the program
 * cannot write. None are protected until this is called. */
void vl_write_protection(unsigned config6);
/* What has been written so far; broken_unlocks counts settings of WR without
 * the sequence 55, AA directly before, which the chip ignores. */
struct vl_nonvolatile_counts {
    uint32_t eeprom_writes, flash_erases, flash_writes, broken_unlocks;
};
void vl_nonvolatile_counts(struct vl_nonvolatile_counts *counts);

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
struct vl_ram_write {
    uint64_t cycle;
    uint32_t address, value, pc;
};
int vl_ram_writes(struct vl_ram_write *entries, int room);
/* One byte per watched address, 1 = written since it is watched; no limit. */
void vl_written(uint8_t flags[4096]);

/* ---- Pins: pins.cc ------------------------------------------------------ */

/* Pins are numbered port * 8 + bit, port 0 = A .. 4 = E: RB4 is 12. */
enum vl_drive {
    VL_LOW = 0,  /* connected to ground */
    VL_HIGH = 1, /* connected to +5 V */
    VL_OPEN = 2  /* not connected: the chip's pull-up decides, if it is on */
};
int vl_pin_drive(int pin, int drive);
/* Connects the pin to `volts` through `ohms` (analogue inputs). */
int vl_pin_drive_volts(int pin, double volts, double ohms);
int vl_pin_level(int pin);
/* Levels of all pins, bit = pin number. */
uint64_t vl_pin_levels(void);
/* Logs changes of the pins in `mask` from now on, forgetting older ones. */
void vl_pin_log(uint64_t mask);
struct vl_pin_change {
    uint64_t cycle;
    uint64_t levels;
};
/* Copies the oldest entries and removes them; returns how many. */
int vl_pin_changes(struct vl_pin_change *entries, int room);

/* ---- Trace: trace.cc ---------------------------------------------------- */

/* Value change dump of all pins; timescale 1 ns. */
int vl_vcd_open(const char *path);
void vl_vcd_close(void);

/* ---- USB: usb_engine.cc, usb_host.cc ------------------------------------ */

/* Puts the models of the serial interface engine and of a host behind the
 * chip, with the cable out (VBUS sense RB6 low).  Call before running. */
void vl_usb_attach(void);
void vl_usb_plug(int in);
/* The cable is in and the firmware has switched its pull-up on. */
int vl_usb_connected(void);
/* Drives the reset state (1) and ends it (0); run 10 ms in between. */
void vl_usb_reset(int active);
/* Stops the frames (1) or lets them go on after resume signalling (0). */
void vl_usb_suspend(int on);

enum vl_token { VL_OUT = 1, VL_IN = 9, VL_SETUP = 13 };
enum vl_handshake { VL_NONE = 0, VL_ACK = 1, VL_NAK = 2, VL_STALL = 3 };
/* Queues one transaction; vl_run() stops with VL_STOP_EVENT when it is over,
 * then vl_usb_result() gives the enum vl_handshake (VL_NONE: no answer), and
 * for IN the data and the toggle.  Before that it gives -1.  fresh says of an
 * OUT that it was never sent before, so that dropping it is a mistake. */
void vl_usb_submit(int token, unsigned address, unsigned endpoint,
                   unsigned toggle, const uint8_t *data, unsigned count,
                   int fresh);
int vl_usb_result(uint8_t data[64], unsigned *count, unsigned *toggle);

/* The serial port: from vl_usb_open() on bulk OUT is sent as long as there is
 * something and bulk IN and the notification endpoint are polled. */
void vl_usb_open(unsigned address, unsigned in, unsigned out, unsigned notify);
void vl_usb_close(void);
/* Both return how many bytes were taken or given; a queue holds 4096. */
unsigned vl_usb_write(const uint8_t *data, unsigned count);
unsigned vl_usb_read(uint8_t *data, unsigned room);
unsigned vl_usb_unsent(void);
/* 1 when the device stalled a bulk endpoint. */
int vl_usb_port_failed(void);
/* Fault injection: the handshakes of the next n transactions are lost. */
void vl_usb_lose_handshakes(unsigned n);
struct vl_usb_counts {
    uint64_t frames, transactions, naks, stalls, timeouts, bytes_in, bytes_out,
        wrong_toggles;
};
void vl_usb_counts(struct vl_usb_counts *counts);
/* Text of the n-th mistake of the firmware; -1 when there are fewer. */
int vl_usb_mistake(unsigned index, char *text, unsigned room);
/* Adds one that only the host can see. */
void vl_usb_report_mistake(const char *text);

/* ---- Machine: machine.cc ------------------------------------------------- */

enum vl_axis { VL_X = 0, VL_Z = 1 };
/* Connects motors, screws and switches to the coil and switch pins; then set
 * up both axes.  Positions are machine coordinates of the slide: 0 is where
 * the limit switch opens, negative towards axis and chuck. */
void vl_machine_attach(void);
struct vl_axis_setup {
    int32_t slide;         /* where the slide stands, full steps */
    int32_t backlash;      /* dead steps of the screw */
    int32_t slack;         /* 0..backlash: how much is taken up now;
                                   backlash = pushed in + direction last */
    int32_t switch_travel; /* closes beyond this, opens at 0 */
    int32_t switch_broken; /* 1: its wire is broken */
    int32_t stop_plus;     /* hard ends of the slide, full steps */
    int32_t stop_minus;
    double pull_in;      /* full steps/s the motor starts at */
    double pull_out;     /* full steps/s it reaches at most */
    double acceleration; /* full steps/s2 between the two */
};
int vl_axis_setup(int axis, const struct vl_axis_setup *setup);
struct vl_axis_state {
    int64_t slide, slack, rotor, commanded; /* half steps */
    uint64_t steps;                         /* changes of the coil pattern */
    uint64_t lost_steps; /* changes the rotor did not follow */
    uint64_t illegal_patterns;
    uint64_t jumps;     /* changes by more than a full step */
    uint64_t end_stops; /* attempts to go past a hard end */
    double fastest;     /* full steps/s */
    int32_t pressed;    /* the switch, before bounce and noise */
};
int vl_axis_read(int axis, struct vl_axis_state *state);
int vl_switch_broken(int axis, int broken, int switch_travel);
/* Emergency stop: without motor power the rotors stay where they are. */
void vl_motor_power(int on);
/* Contact bounce after each change in us, noise pulses per second. */
void vl_switch_quality(unsigned bounce_us, unsigned noise_hz, unsigned seed);

/* Contact sensor between tool and a metal (below): RA1 low while they touch,
 * with the bounce of vl_switch_quality().  zero_x, zero_z: machine position of
 * the slides, full steps, with the tip at the metal's (0, 0); again after each
 * change of tool.  Without one RA1 is pulled up. */
void vl_probe_attach(int metal, double zero_x, double zero_z);
/* Looks again: after vl_metal_move(). */
void vl_probe_look(void);
/* A chip or a chafed wire connects tool and work. */
void vl_probe_short(int shorted);

/* Every movement of a slide, and everything that went wrong.  Both functions
 * hand out the oldest entries and forget them; they return how many. */
struct vl_move {
    uint64_t cycle;
    int64_t x, z;
}; /* half steps */
int vl_moves(struct vl_move *entries, int room);
enum vl_fault_kind {
    VL_FAULT_PATTERN = 0,   /* value: the coil pattern */
    VL_FAULT_JUMP = 1,      /* value: half steps */
    VL_FAULT_LOST_STEP = 2, /* value: full steps/s asked for */
    VL_FAULT_END_STOP = 3   /* value: full steps */
};
struct vl_fault {
    uint64_t cycle;
    int32_t axis;
    int32_t kind;
    int64_t value;
};
int vl_faults(struct vl_fault *entries, int room);

/* ---- Panel: lcd.cc, lcd_bus.cc, keys.cc; converter: adc.cc --------------- */

/* An HD44780 display of two lines of 16 on RA2..RA5 (D4..D7), RE0 (RS) and
 * RE1 (E).  The frequency of its own clock decides how long it is busy: 190
 * to 350 kHz by the data sheet, 270 typically.  Power comes to it now, and
 * again with each power-on reset of the chip; other resets leave it alone. */
void vl_lcd_attach(double oscillator_khz);
struct vl_lcd_state {
    uint8_t ddram[80]; /* character codes, 40 of the first line first */
    uint8_t cgram[64]; /* eight rows of 5 dots to a custom character */
    uint8_t on;        /* the display shows something */
    uint8_t two_lines; /* the function set has said so */
    uint8_t cursor;    /* a line under the character at the address */
    uint8_t blink;     /* that character blinks */
    uint8_t in_cgram;  /* data go to CGRAM */
    int32_t address;   /* 0..79: where data go in DDRAM */
    int32_t shift;     /* 0..39: column of DDRAM shown leftmost */
    uint64_t writes;   /* bytes taken since power came */
};
void vl_lcd_read(struct vl_lcd_state *state);
/* Every byte, with the cycle of the fall of E that completed it.  Hands out
 * the oldest entries, of at most 65,536, and forgets them. */
struct vl_lcd_byte {
    uint64_t cycle;
    uint8_t data; /* 0: an instruction */
    uint8_t value;
};
int vl_lcd_bytes(struct vl_lcd_byte *entries, int room);
/* Text of the n-th mistake of the firmware; -1 when there are fewer. */
int vl_lcd_mistake(unsigned index, char *text, unsigned room);

/* The ladder of eight keys on RA0, with its capacitor. */
void vl_keys_attach(void);
/* Bit k: a finger is on key k.  Contacts bounce by vl_switch_quality(). */
void vl_keys_hold(unsigned held);

/* Mistakes in the use of the A/D converter, panel or not. */
int vl_adc_mistake(unsigned index, char *text, unsigned room);

/* ---- Metal: metal.cc, reach.cc ------------------------------------------- */

/* A bar that a tool cuts, in part coordinates: x a radius, z = 0 the front of
 * the finished part, both in steps.  It needs no chip; there may be many. */
#define VL_COLUMNS_PER_STEP 16
struct vl_tool {
    double nose;       /* radius of the nose, steps */
    double width;      /* of a grooving tool, from the tip away from the chuck;
                          0: the tool ends in its nose */
    double chuck_edge; /* degrees between the Z axis and the edge towards the */
    double free_edge;  /* chuck and towards the free end; 90 = square */
};
/* Returns a number for the calls below; radii stand at first_z..last_z. */
int vl_metal_new(double radius, int first_z, int last_z);
void vl_metal_tool(int metal, const struct vl_tool *tool);
struct vl_path {
    double x_from, z_from, x_to, z_to; /* of the tip */
};
struct vl_cut {
    int32_t columns; /* how often one was lowered, 0: nothing was touched */
    int32_t fallen;  /* column from which on the bar fell off, or -1 */
    double reach;    /* from the tip to the highest metal it removed, steps */
};
/* Moves the tool on a straight line; a trial only tells what it would cut. */
void vl_metal_move(int metal, const struct vl_path *path, int trial,
                   struct vl_cut *cut);
/* Radii of all columns; returns how many there are. */
int vl_metal_radii(int metal, double *radii, int room);
double vl_metal_radius(int metal, int column);
/* The same of the piece that fell off last, from its first column on. */
int vl_metal_fallen(int metal, double *radii, int room);
/* How far above its tip the tool begins at a distance u along Z. */
double vl_tool_outline(const struct vl_tool *tool, double u);
/* The lowest surface a tool can cut without going below the wanted one, both
 * with `count` radii, `per_step` of them to a step. */
void vl_reach(const struct vl_tool *tool, const double *wanted, double *reached,
              int count, int per_step);
/* How far a radius at a column stands above such a surface, in steps: the
 * distance to the lines between its radii.  Infinite radii are no surface. */
double vl_above(const double *surface, int count, int per_step, int column,
                double radius);

#ifdef __cplusplus
}
#endif
#endif
