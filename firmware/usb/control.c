/* Endpoint 0: control transfers, from SETUP to status stage.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 *   SETUP --stalled--------------------------------------> IDLE (both BSTALL)
 *         --no data-->  STATUS_IN --our empty IN sent---> IDLE
 *         --to host-->  DATA_IN   --OUT of the host-----> IDLE
 *         --to chip-->  DATA_OUT  --data---> STATUS_IN --> IDLE
 *
 * A SETUP is taken in every stage: it ends what was under way (USB 2.0,
 * 8.5.3). From SETUP until control_setup() clears PKTDIS at its end the engine
 * handles no packet at all, so in between every descriptor may be changed,
 * including those of the data endpoints.
 *
 * The OUT buffer is handed over as soon as it has been read, so that the next
 * SETUP always finds room. While no OUT data are expected it is armed for
 * DATA0: a status packet that the host repeats because it missed our ACK is
 * DATA1, and is acknowledged and dropped by the engine.
 */
#include "sfr.h"
#include "usb/cdc.h"
#include "usb/engine.h"

#define SETUP_TYPE usb_ep0_out[0]
#define SETUP_LENGTH_LOW usb_ep0_out[6]
#define SETUP_LENGTH_HIGH usb_ep0_out[7]

#define TYPE_TO_HOST 0x80
#define TYPE_MASK 0x60
#define TYPE_STANDARD 0x00
#define TYPE_CLASS 0x20

#define NO_ADDRESS 0xFF

static void arm_out(uint8_t stat)
{
    usb_bd[BD_EP0_OUT].cnt = EP0_SIZE;
    usb_bd[BD_EP0_OUT].stat = stat;
}

/* Hands the first `count` bytes of usb_ep0_in over, DATA1 and DATA0 in turn
 * beginning with DATA1. */
static void arm_in(uint8_t count)
{
    usb_in_stat ^= BD_DTS;
    usb_bd[BD_EP0_IN].cnt = count;
    usb_bd[BD_EP0_IN].stat = usb_in_stat;
}

static void stall(void)
{
    usb_stage = STAGE_IDLE;
    usb_bd[BD_EP0_IN].stat = BD_HALT;
    arm_out(BD_HALT); /* a SETUP is accepted all the same */
}

void control_reset(void)
{
    usb_new_address = NO_ADDRESS;
    usb_stage = STAGE_IDLE;
    usb_bd[BD_EP0_IN].stat = 0;
    arm_out(BD_UOWN | BD_DTSEN);
}

/* The next packet of the data stage. */
static void send_data(void)
{
    uint8_t count = usb_left;

    if (count > EP0_SIZE) {
        count = EP0_SIZE;
    }
    if (!count) {
        usb_source = SOURCE_BUFFER;
    }
    if (usb_source == SOURCE_FLASH) {
        usb_copy_flash(usb_next, count);
    } else if (usb_source == SOURCE_RAM) {
        usb_copy(usb_ep0_in, (__data uint8_t *)usb_next, count);
    }
    usb_next += count;
    usb_left -= count;
    if (count < EP0_SIZE) {
        usb_ends_short = 0;
    }
    arm_in(count);
}

static void send_status(void)
{
    usb_stage = STAGE_STATUS_IN;
    usb_in_stat = BD_UOWN | BD_DTSEN; /* arm_in() makes it DATA1 */
    arm_in(0);
}

/* Not more than the host asked for. Less than that, in full packets, needs an
 * empty one at the end. */
static void limit_data(void)
{
    usb_ends_short = 1;
    if (SETUP_LENGTH_HIGH || usb_left < SETUP_LENGTH_LOW) {
        return;
    }
    usb_ends_short = 0;
    usb_left = SETUP_LENGTH_LOW;
}

void control_setup(void)
{
    uint8_t type = SETUP_TYPE & TYPE_MASK;
    uint8_t accepted = 0;

    usb_bd[BD_EP0_IN].stat = 0;
    UEP0 &= (uint8_t)~UEP_EPSTALL;
    usb_new_address = NO_ADDRESS;
    usb_source = SOURCE_BUFFER;
    usb_left = 0;

    if (type == TYPE_STANDARD) {
        accepted = standard_request();
    } else if (type == TYPE_CLASS) {
        accepted = cdc_request();
    }

    type = SETUP_TYPE;
    if (!accepted) {
        stall();
    } else if (!SETUP_LENGTH_LOW && !SETUP_LENGTH_HIGH) {
        send_status();
        arm_out(BD_UOWN | BD_DTSEN);
    } else if (type & TYPE_TO_HOST) {
        limit_data();
        usb_stage = STAGE_DATA_IN;
        usb_in_stat = BD_UOWN | BD_DTSEN;
        send_data();
        arm_out(BD_UOWN | BD_DTSEN | BD_DTS);
    } else {
        usb_stage = STAGE_DATA_OUT;
        arm_out(BD_UOWN | BD_DTSEN | BD_DTS);
    }
    UCON &= (uint8_t)~UCON_PKTDIS;
}

void control_out(void)
{
    if (usb_stage == STAGE_DATA_OUT) {
        /* The one request with data is SET_LINE_CODING. */
        if (usb_bd[BD_EP0_OUT].cnt != LINE_CODING_LENGTH) {
            stall();
            return;
        }
        usb_copy(usb_line_coding, usb_ep0_out, LINE_CODING_LENGTH);
        send_status();
    } else if (usb_stage == STAGE_DATA_IN) {
        /* The status stage of a read, perhaps before all data were sent. */
        usb_stage = STAGE_IDLE;
    }
    arm_out(BD_UOWN | BD_DTSEN);
}

void control_in(void)
{
    if (usb_stage == STAGE_DATA_IN) {
        if (usb_left || usb_ends_short) {
            send_data();
        }
    } else if (usb_stage == STAGE_STATUS_IN) {
        usb_stage = STAGE_IDLE;
        /* Only now: the host still used the old address for this packet. */
        if (usb_new_address != NO_ADDRESS) {
            UADDR = usb_new_address;
            usb_state = usb_new_address ? USB_ADDRESS : USB_DEFAULT;
            usb_new_address = NO_ADDRESS;
        }
    }
}
