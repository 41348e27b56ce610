/* CRC-16/CCITT-FALSE: guards frames, stored parts and settings.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Polynomial 0x1021, start value 0xFFFF, bits not reflected, result not
 * inverted; "123456789" gives 0x29B1. It finds every error burst of up to 16
 * bits, and every single, double and odd number of wrong bits in the few
 * hundred bytes guarded here.
 *
 *     uint16_t crc = CRC16_INITIAL;
 *     crc = crc16_update(crc, first);
 *     crc = crc16_update(crc, second);
 */
#ifndef LINK_CRC_H
#define LINK_CRC_H

#include <stdint.h>

#include "link/protocol.h" /* CRC16_INITIAL */

/* The CRC of what `crc` covered, followed by `byte`. Main loop or low-priority
 * interrupt; it keeps no state. 29 cycles, 2.4 us, plus pushing the
 * arguments. */
uint16_t crc16_update(uint16_t crc, uint8_t byte);

/* The CRC of what `crc` covered, followed by data[0 .. length - 1] in RAM;
 * length 1..255 (0 counts as 256). Main loop only. 20 cycles per byte + 31:
 * 60 bytes take 0.1 ms. */
uint16_t crc16_block(uint16_t crc, __data const uint8_t *data, uint8_t length);

#endif
