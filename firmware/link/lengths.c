/* Lengths of requests.
   SPDX-License-Identifier: Apache-2.0 */

#include "link/lengths.h"
#include "link/frame.h"    /* the request */
#include "link/protocol.h" /* numbers */

#define NONE 0xFF /* no command has this number */
#define OPEN 0xFE /* from _MIN to _MAX */

#if COMMAND_SERIAL_SET != 0x22 || COMMAND_UPLOAD_DATA != 0x11
#error "the table below goes by the numbers of the commands"
#endif

/* Payload of each command, by its number. */
/* clang-format off */
static __code const uint8_t lengths[] = {
    NONE,  /* 0x00 */
    HELLO_REQUEST_SIZE,  /* 0x01 */
    STATUS_REQUEST_SIZE,  /* 0x02 */
    HOME_REQUEST_SIZE,  /* 0x03 */
    RUN_REQUEST_SIZE,  /* 0x04 */
    HOLD_REQUEST_SIZE,  /* 0x05 */
    RESUME_REQUEST_SIZE,  /* 0x06 */
    STOP_REQUEST_SIZE,  /* 0x07 */
    RESET_REQUEST_SIZE,  /* 0x08 */
    ZERO_REQUEST_SIZE,  /* 0x09 */
    OVERRIDE_REQUEST_SIZE,  /* 0x0A */
    JOG_REQUEST_SIZE,  /* 0x0B */
    GOTO_REQUEST_SIZE,  /* 0x0C */
    TOUCH_REQUEST_SIZE,  /* 0x0D */
    LOADER_REQUEST_SIZE,  /* 0x0E */
    PROGRESS_REQUEST_SIZE,  /* 0x0F */
    UPLOAD_BEGIN_REQUEST_SIZE,  /* 0x10 */
    OPEN,  /* 0x11 UPLOAD_DATA */
    UPLOAD_COMMIT_REQUEST_SIZE,  /* 0x12 */
    PART_INFO_REQUEST_SIZE,  /* 0x13 */
    PART_READ_REQUEST_SIZE,  /* 0x14 */
    PART_SELECT_REQUEST_SIZE,  /* 0x15 */
    PART_DELETE_REQUEST_SIZE,  /* 0x16 */
    NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE,  /* 0x17 */
    SETTING_GET_REQUEST_SIZE,  /* 0x20 */
    SETTING_SET_REQUEST_SIZE,  /* 0x21 */
    SERIAL_SET_REQUEST_SIZE   /* 0x22 */
};
/* clang-format on */

uint8_t lengths_fit(void)
{
    uint8_t length;

    if (frame_code > COMMAND_SERIAL_SET) {
        return 1; /* unknown commands are answered as such */
    }
    length = lengths[frame_code];
    if (length == OPEN) {
        return frame_length >= UPLOAD_DATA_REQUEST_MIN &&
               frame_length <= UPLOAD_DATA_REQUEST_MAX;
    }
    return length == NONE || length == frame_length;
}
