/*
 * Pins of the Tornillo board, and of a board built after the thesis the
 * project started from: the same motor, switch, LED and USB pins.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * BOARD_PIN(NAME, PORT, BIT) lines are the table that the board's netlist is
 * checked against, so keep one per line; each also makes NAME_MASK.
 *
 * Inputs that a plain board leaves open have pull-ups inside the chip, so
 * that an open input reads as "nothing pressed", except the emergency-stop
 * sense, where an open wire must stop the machine (a board without one sets
 * the setting estop_fitted to 0, or links RD7 to ground).
 */
#ifndef BOARD_H
#define BOARD_H

#define BOARD_PIN(name, port, bit) enum { name##_MASK = 1 << (bit) };

/* clang-format off */
BOARD_PIN(COIL_Z1, B, 0)            /* 1 = winding on */
BOARD_PIN(COIL_Z2, B, 1)
BOARD_PIN(COIL_Z3, B, 2)
BOARD_PIN(COIL_Z4, B, 3)
BOARD_PIN(LIMIT_X, B, 4)            /* 1 = pressed, or the wire is broken */
BOARD_PIN(LIMIT_Z, B, 5)
BOARD_PIN(VBUS_SENSE, B, 6)         /* 0 = no USB supply; open = present */
BOARD_PIN(LED_STATUS, C, 0)         /* 1 = lit */
BOARD_PIN(SPINDLE_INDEX, C, 2)      /* reserved */
BOARD_PIN(USB_DM, C, 4)
BOARD_PIN(USB_DP, C, 5)
BOARD_PIN(SPINDLE_RELAY, C, 6)      /* 1 = on */
BOARD_PIN(COOLANT_RELAY, C, 7)      /* 1 = on */
BOARD_PIN(COIL_X1, D, 0)            /* 1 = winding on */
BOARD_PIN(COIL_X2, D, 1)
BOARD_PIN(COIL_X3, D, 2)
BOARD_PIN(COIL_X4, D, 3)
BOARD_PIN(BUTTON_RUN, D, 4)         /* 0 = pressed */
BOARD_PIN(BUTTON_HOLD, D, 5)        /* 0 = pressed */
BOARD_PIN(BUTTON_STOP, D, 6)        /* 0 = pressed */
BOARD_PIN(ESTOP_SENSE, D, 7)        /* 0 = motor power present */
BOARD_PIN(KEY_LADDER, A, 0)         /* analogue: keys of the panel */
BOARD_PIN(PROBE, A, 1)              /* 0 = contact; pulled up outside */
BOARD_PIN(LCD_D4, A, 2)             /* display of the panel */
BOARD_PIN(LCD_D5, A, 3)             /* display of the panel */
BOARD_PIN(LCD_D6, A, 4)             /* display of the panel */
BOARD_PIN(LCD_D7, A, 5)             /* display of the panel */
BOARD_PIN(LCD_RS, E, 0)             /* display of the panel */
BOARD_PIN(LCD_E, E, 1)              /* display of the panel */
/* clang-format on */

/* Directions: 1 = input. The upper halves of ports B and D are inputs, so
   the step interrupt may write the whole latch. */
#define TRISA_BOARD 0x3F
#define TRISB_BOARD 0xF0
#define TRISC_BOARD 0x3E
#define TRISD_BOARD 0xF0
#define TRISE_BOARD 0x07

#endif
