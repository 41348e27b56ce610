/* The serial port: its data endpoints, and the requests of its class.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Endpoint 2 is a pair of one-packet mail boxes between the main loop and the
 * engine. Who owns a box follows from three notes:
 *
 *   OUT   received == 0, not armed   the interrupt arms it (cdc_pump)
 *         armed                      the engine fills it
 *         received != 0              the main loop reads it, then clears
 *                                    `received` and raises USBIF
 *   IN    sending == 0               the main loop fills it, sets `sending`
 *                                    and raises USBIF
 *         sending != 0, not armed    the interrupt arms it (cdc_pump)
 *         armed                      the engine sends it
 *
 * `received` survives a bus reset and an unplugged cable: the main loop may be
 * reading the packet at that moment, so the box is not armed before it has
 * been released.
 */
#include "usb/cdc.h"

#include "usb/engine.h"
#include "sfr.h"

/* Class requests: CDC 1.2 and PSTN 1.2, table 13. */
#define SET_LINE_CODING 0x20
#define GET_LINE_CODING 0x21
#define SET_CONTROL_LINE_STATE 0x22
#define SEND_BREAK 0x23

/* Notification, and what it says: carrier and data set ready, for good. Some
 * programs wait for them before they open the port. */
#define SERIAL_STATE 0x20

/* bmRequestType; the second is also the first byte of a notification. */
#define TO_INTERFACE 0x21
#define FROM_INTERFACE 0xA1

#define LINE_STATE_DTR 0x01

#define SERIAL_STATE_LENGTH 10
#define SERIAL_STATE_DCD_DSR 0x03

volatile uint8_t cdc_closed;

/* 115200 baud, 1 stop bit, no parity, 8 bits. Stored and reported, otherwise of
 * no effect: there is no wire with a baud rate behind this port. */
void cdc_line_coding_default(void)
{
    usb_line_coding[0] = 115200UL & 0xFF;
    usb_line_coding[1] = 115200UL >> 8 & 0xFF;
    usb_line_coding[2] = 115200UL >> 16 & 0xFF;
    usb_line_coding[3] = 0;
    usb_line_coding[4] = 0;
    usb_line_coding[5] = 0;
    usb_line_coding[6] = 8;
}

void cdc_reset(void)
{
    usb_bd[BD_EP1_IN].stat = 0;
    usb_bd[BD_EP2_OUT].stat = 0;
    usb_bd[BD_EP2_IN].stat = 0;
    usb_armed = 0;
    usb_halted = 0;
    usb_sending = 0;
    usb_notify = 0;
    usb_line_state = 0;
    cdc_closed = 1;
}

void cdc_configure(void)
{
    UEP1 = UEP_EPHSHK | UEP_EPCONDIS | UEP_EPINEN;
    UEP2 = UEP_EPHSHK | UEP_EPCONDIS | UEP_EPOUTEN | UEP_EPINEN;
    usb_toggle = 0;
    usb_notify = 1;
}

void cdc_restart(uint8_t bits, uint8_t stat)
{
    if (bits & EP1_IN_BIT) {
        usb_bd[BD_EP1_IN].cnt = 0;
        usb_bd[BD_EP1_IN].stat = stat;
    }
    if (bits & EP2_OUT_BIT) {
        usb_bd[BD_EP2_OUT].cnt = 0;
        usb_bd[BD_EP2_OUT].stat = stat;
    }
    if (bits & EP2_IN_BIT) {
        usb_bd[BD_EP2_IN].cnt = 0;
        usb_bd[BD_EP2_IN].stat = stat;
    }
    bits = ~bits;
    usb_armed &= bits;
    usb_toggle &= bits;
    usb_halted &= bits;
    if (stat) {
        usb_halted |= (uint8_t)~bits;
    }
}

void cdc_transaction(uint8_t bit)
{
    usb_armed &= (uint8_t)~bit;
    usb_toggle ^= bit;
    if (bit == EP2_OUT_BIT) {
        usb_received = usb_bd[BD_EP2_OUT].cnt; /* 0: cdc_pump arms again */
    } else if (bit == EP2_IN_BIT) {
        usb_sending = 0;
    }
}

static void write_serial_state(void)
{
    usb_ep1_in[0] = FROM_INTERFACE;
    usb_ep1_in[1] = SERIAL_STATE;
    usb_ep1_in[2] = 0;
    usb_ep1_in[3] = 0;
    usb_ep1_in[4] = 0; /* interface */
    usb_ep1_in[5] = 0;
    usb_ep1_in[6] = 2; /* bytes that follow */
    usb_ep1_in[7] = 0;
    usb_ep1_in[8] = SERIAL_STATE_DCD_DSR;
    usb_ep1_in[9] = 0;
}

/* BDnSTAT that hands the buffer of `bit` over with the toggle it is at. */
static uint8_t handover(uint8_t bit)
{
    usb_armed |= bit;
    if (usb_toggle & bit) {
        return BD_UOWN | BD_DTSEN | BD_DTS;
    }
    return BD_UOWN | BD_DTSEN;
}

void cdc_pump(void)
{
    uint8_t busy = usb_armed | usb_halted;

    if (usb_state != USB_CONFIGURED) {
        usb_sending = 0;
        return;
    }
    /* While the main loop has not yet forgotten who was there before, whoever
     * comes next is made to wait. */
    if (!(busy & EP2_OUT_BIT) && !usb_received && !cdc_closed) {
        usb_bd[BD_EP2_OUT].cnt = EP2_SIZE;
        usb_bd[BD_EP2_OUT].stat = handover(EP2_OUT_BIT);
    }
    if (!(busy & EP2_IN_BIT) && usb_sending) {
        usb_bd[BD_EP2_IN].cnt = usb_sending;
        usb_bd[BD_EP2_IN].stat = handover(EP2_IN_BIT);
    }
    if (!(busy & EP1_IN_BIT) && usb_notify) {
        usb_notify = 0;
        write_serial_state();
        usb_bd[BD_EP1_IN].cnt = SERIAL_STATE_LENGTH;
        usb_bd[BD_EP1_IN].stat = handover(EP1_IN_BIT);
    }
}

/* The port was opened or closed. Nobody will collect a reply that waits when
 * it closes. */
static void set_line_state(void)
{
    usb_line_state = usb_ep0_out[2];
    if (usb_line_state & LINE_STATE_DTR) {
        return;
    }
    cdc_closed = 1;
    usb_sending = 0;
    if (!(usb_halted & EP2_OUT_BIT)) {
        usb_bd[BD_EP2_OUT].stat = 0;
        usb_armed &= (uint8_t)~EP2_OUT_BIT;
    }
    if (!(usb_halted & EP2_IN_BIT)) {
        usb_bd[BD_EP2_IN].stat = 0;
        usb_armed &= (uint8_t)~EP2_IN_BIT;
    }
}

uint8_t cdc_request(void)
{
    uint8_t type = usb_ep0_out[0];
    uint8_t request = usb_ep0_out[1];
    uint8_t length = usb_ep0_out[6];

    if (usb_state != USB_CONFIGURED) {
        return 0;
    }
    /* Interface 0 has them all. */
    if (usb_ep0_out[4] || usb_ep0_out[5]) {
        return 0;
    }
    if (type == FROM_INTERFACE) {
        if (request != GET_LINE_CODING) {
            return 0;
        }
        usb_source = SOURCE_RAM;
        usb_next = (uint16_t)usb_line_coding;
        usb_left = LINE_CODING_LENGTH;
        return 1;
    }
    if (type != TO_INTERFACE || usb_ep0_out[7]) {
        return 0;
    }
    if (request == SET_LINE_CODING) {
        return length == LINE_CODING_LENGTH;
    }
    if (length) {
        return 0;
    }
    if (request == SET_CONTROL_LINE_STATE) {
        set_line_state();
        return 1;
    }
    return request == SEND_BREAK;
}

uint8_t cdc_received(void)
{
    return usb_received;
}

void cdc_release(void)
{
    usb_received = 0;
    PIR2 |= PIR2_USBIF;
}

uint8_t cdc_send_ready(void)
{
    return !usb_sending;
}

void cdc_send(uint8_t length)
{
    usb_sending = length;
    PIR2 |= PIR2_USBIF;
}
