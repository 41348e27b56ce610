/* The USB serial port (CDC-ACM) of the lathe. This header is the manual; the
 * rest of the firmware needs nothing else from this room.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * What a user gets: a serial port that appears on Linux, Windows 10 and macOS
 * without a driver, at any time, and may vanish at any time. Nothing here ever
 * waits for a host: every call returns at once, and with no cable at all the
 * only cost is a few cycles each millisecond.
 *
 * How the parts fit
 *
 *     main()            usb_init() once, with interrupts still off
 *     low interrupt     if (PIR2 & 0x20) usb_service();     USBIF
 *     1 ms tick         usb_tick();                         low interrupt too
 *     main loop         the cdc_ calls, any time, never from an interrupt
 *
 * The low interrupt must save what SDCC saves for an __interrupt function
 * (WREG, STATUS, BSR, FSR0, PROD ...). TBLPTR and TABLAT are saved in here.
 *
 * Interrupt time. One call of usb_service() handles one transaction; the next
 * one raises the interrupt again. See README.md for the measured worst cases.
 * GIEH is never touched, so the step interrupt is not delayed at all.
 *
 * Receiving: packets of 1..64 bytes, in order, none lost. While the main loop
 * holds one packet the host is told to wait (NAK), for as long as it takes.
 *
 *     uint8_t length = cdc_received();
 *     if (length) {
 *         ... read cdc_packet[0 .. length - 1] ...
 *         cdc_release();          the next packet may come
 *     }
 *
 * Sending: write straight into the buffer, then say how many bytes.
 *
 *     if (cdc_send_ready()) {
 *         cdc_reply[0] = ...;
 *         cdc_send(length);
 *     }
 *
 * The buffer keeps its content after it was sent: the same reply can be sent
 * again by another cdc_send(). A reply that nobody collects is dropped when the
 * host closes the port (DTR falls), resets the bus or pulls the cable. Replies
 * do not wait for DTR: some programs never raise it.
 */
#ifndef USB_CDC_H
#define USB_CDC_H

#include <stdint.h>

#define CDC_PACKET_SIZE 64

/* ---- Life cycle --------------------------------------------------------- */

/* Sets up memory and registers and reads the serial number from EEPROM. Main,
 * once, before GIEL is set; takes 60 us. Leaves the engine off: usb_tick()
 * turns it on when there is a cable. Enables its own interrupt at low
 * priority. */
void usb_init(void);

/* Serves the engine: at most one transaction, bus reset, suspend, resume. Low
 * interrupt, when USBIF is set; clears USBIF. */
void usb_service(void);

/* Cable detection. Low interrupt, every millisecond. */
void usb_tick(void);

/* ---- Serial number ------------------------------------------------------ */

/* The serial number as the host sees it: character i (0..7). Any context,
 * after usb_init(). */
#define USB_SERIAL_CHARACTER(i) (usb_serial_descriptor[2 + 2 * (i)])
extern volatile uint8_t usb_serial_descriptor[18];

/* Reads it from EEPROM anew, after it was changed there. Main loop. A host that
 * asks at that very moment may see half of it. */
void usb_read_serial_number(void);

/* ---- Receiving (main loop) ---------------------------------------------- */

/* The last packet from the host; belongs to the main loop from the moment
 * cdc_received() is not 0 until cdc_release(). */
extern volatile uint8_t cdc_packet[CDC_PACKET_SIZE];

/* Bytes in cdc_packet, 1..64; 0 = no packet. */
uint8_t cdc_received(void);

/* Done with cdc_packet. Only after cdc_received() was not 0, or cdc_closed. */
void cdc_release(void);

/* Not 0 = the port was closed, the bus reset or the cable pulled since the
 * main loop last cleared it: what has arrived before belongs to somebody who
 * is gone. No packet is taken until it is cleared and cdc_release() called. */
extern volatile uint8_t cdc_closed;

/* ---- Sending (main loop) ------------------------------------------------ */

/* The next packet to the host; belongs to the main loop while
 * cdc_send_ready() is 1. */
extern volatile uint8_t cdc_reply[CDC_PACKET_SIZE];

/* 1 = nothing under way, cdc_reply may be written. With no host this is 1:
 * what is sent then is dropped. */
uint8_t cdc_send_ready(void);

/* Sends cdc_reply[0 .. length - 1] as one packet. Only while cdc_send_ready()
 * is 1. `length` is 1..63: a host takes a packet shorter than 64 bytes as the
 * end of a transfer and hands it on at once. */
void cdc_send(uint8_t length);

#endif
