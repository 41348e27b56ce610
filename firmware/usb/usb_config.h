/* Everything about the USB device that a builder may want to change.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * The descriptors (descriptors.c) and the driver take their numbers from here
 * and from nowhere else. Numbers the specifications fix are not in this file.
 */
#ifndef USB_CONFIG_H
#define USB_CONFIG_H

/* ---- Identity -----------------------------------------------------------
 * USB_VENDOR_ID and USB_PRODUCT_ID come from link/protocol.toml, where the
 * host program takes them from too. 1209:0001 is the id that pid.codes keeps
 * open for tests and prototypes; a product that is sold needs one of its own.
 */
#include "board.h"         /* VBUS_SENSE_MASK */
#include "link/protocol.h" /* USB_VENDOR_ID, USB_PRODUCT_ID, SERIAL_LENGTH */

/* Release of the device as binary coded decimal: 0x0100 is 1.00. */
#define USB_DEVICE_RELEASE_BCD 0x0100

/* The serial number: 8 characters of ASCII in the data EEPROM, see
 * serial_number.asm. A character that hosts refuse (blank EEPROM, space, comma,
 * anything outside 0x21..0x7E) reads as "0". The command SERIAL_SET changes it.
 */

/* ---- Power --------------------------------------------------------------
 * USB_SELF_POWERED: 1 = the lathe runs from a supply of its own, whether a
 * cable is plugged or not. That is the normal case, and the one in which the
 * chip may go on cutting while the bus is suspended. 0 = the whole board lives
 * on the cable; then a suspended bus allows 2.5 mA only, which a lathe in the
 * middle of a cut cannot honour.
 *
 * USB_BUS_CURRENT_MA: the most that is taken from the cable, 0..500 mA in
 * steps of 2. 100 mA covers the board of the paper, which feeds the chip
 * (30 mA), the status LED and four opto-couplers with their LEDs (4 x 8 mA)
 * from VBUS. A self-powered board may draw less than it declares, so one
 * number serves both.
 */
#ifndef USB_SELF_POWERED
#define USB_SELF_POWERED 1
#endif
#ifndef USB_BUS_CURRENT_MA
#define USB_BUS_CURRENT_MA 100
#endif

/* ---- VBUS sense ---------------------------------------------------------
 * Pin that is high while the cable carries power. With the pin left open the
 * internal pull-up says "always", which suits a board fed by the cable.
 *
 * USB_ATTACH_MS: power must be there for so long before the pull-up on D+ is
 * switched on (1..255 ms). Plugs bounce; the specification gives 100 ms.
 * USB_DETACH_MS: power must be away for so long before the engine is switched
 * off (1..255 ms). Short, so that D+ does not feed an unpowered host.
 */
#define USB_VBUS_PORT PORTB
#define USB_VBUS_MASK VBUS_SENSE_MASK
#define USB_ATTACH_MS 50
#define USB_DETACH_MS 5

/* ---- Nonsense is refused here ------------------------------------------- */
#if USB_BUS_CURRENT_MA < 0 || USB_BUS_CURRENT_MA > 500
#error "USB_BUS_CURRENT_MA: USB 2.0 allows 0..500 mA"
#endif
#if USB_BUS_CURRENT_MA % 2
#error "USB_BUS_CURRENT_MA: the descriptor counts in units of 2 mA"
#endif
#if USB_SELF_POWERED != 0 && USB_SELF_POWERED != 1
#error "USB_SELF_POWERED: 0 or 1"
#endif
#if USB_ATTACH_MS < 1 || USB_ATTACH_MS > 255
#error "USB_ATTACH_MS: 1..255"
#endif
#if USB_DETACH_MS < 1 || USB_DETACH_MS > 255
#error "USB_DETACH_MS: 1..255"
#endif

#endif
