/* Frames: one request from the host, one response from the chip.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * On the wire (docs: link/README.md) a frame is COBS(seq, code, payload, CRC)
 * and a zero byte. Here only the payload matters:
 *
 *     main loop      frame_poll();           as often as it comes round
 *     commands.c     uint8_t commands_execute(void);
 *
 * frame_poll() takes what has arrived on the USB port, at most
 * FRAME_BYTES_PER_POLL bytes a call, and calls commands_execute() once for each
 * request that is whole, correct and new. commands_execute() finds
 *
 *     frame_code                            the command
 *     frame_payload[0 .. frame_length - 1]  0..56 bytes
 *
 * and writes its response to frame_response[0 .. 55]: [0] is the error code,
 * data follow. It returns the number of bytes written, 1..56. Both arrays may
 * be read and written freely until it returns; multi-byte fields are little
 * endian, as the chip has them, so *(uint16_t *)&frame_payload[2] works.
 * frame_response holds whatever was there before: write all you return.
 *
 * A request that the host repeats because the response got lost has the seq and
 * the CRC of the one before; it gets the same bytes again and
 * commands_execute() is not called. HELLO is always executed. A frame with a
 * wrong CRC, wrong COBS or wrong length is dropped and counted.
 *
 * Nothing waits: while a response is still on its way no further byte is taken
 * from the port, which makes the host wait. With no host nothing happens.
 *
 * Time of one call, beside commands_execute(): see README.md.
 */
#ifndef LINK_FRAME_H
#define LINK_FRAME_H

#include <stdint.h>

#include "link/protocol.h" /* FRAME_... */
#include "usb/cdc.h"       /* cdc_reply */

/* Bytes taken from the port in one call of frame_poll(), 1..64: bounds the
 * time that the main loop is away from the step stream. */
#define FRAME_BYTES_PER_POLL 16

/* The request as it was sent: seq, code, payload, CRC. */
extern uint8_t frame_request[FRAME_BODY_MAX];
#define frame_code (frame_request[FRAME_CODE_AT])
#define frame_payload (frame_request + FRAME_PAYLOAD_AT)
extern uint8_t frame_length; /* payload bytes of the request */

/* The response is made in the USB buffer itself, behind the COBS byte, the seq
 * and the code. */
#define frame_response (cdc_reply + 1 + FRAME_PAYLOAD_AT)

/* Frames dropped since the chip started; stops at 65535. */
extern uint16_t frame_bad_frames;

/* Main loop. */
void frame_poll(void);

/* Written by the commands: carries out the request (see above). */
uint8_t commands_execute(void);

#endif
