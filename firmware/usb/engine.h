/* The serial interface engine of the PIC18F4550: registers, memory, and what
 * the files of this room share. Nobody outside firmware/usb/ includes this;
 * the rest of the firmware talks to cdc.h.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Bit and register names are those of the data sheet (DS39632, chapter 17).
 *
 * Memory: the engine reaches 0x400..0x7FF, this driver lives in 0x400..0x4FF;
 * memory.asm is the map.
 *
 * Who may touch what. Everything here belongs to the low-priority interrupt,
 * with the two exceptions that cdc.h hands to the main loop. The main loop
 * never writes a buffer descriptor or an engine register: it leaves a note in
 * a single byte and raises USBIF, and the interrupt does the rest. So nothing
 * has to be locked. At interrupt level, a descriptor that the engine owns is
 * taken back only while PKTDIS (from SETUP until we clear it), a bus reset or
 * USBEN = 0 keeps the engine from using it.
 */
#ifndef USB_ENGINE_H
#define USB_ENGINE_H

#include <stdint.h>

/* ---- Register bits ------------------------------------------------------ */
#define UCON_PKTDIS 0x10
#define UCON_USBEN 0x08
#define UCON_SUSPND 0x02

#define UCFG_UPUEN 0x10
#define UCFG_FSEN 0x04

/* UIR and UIE share their layout. */
#define UIR_STALLIF 0x20
#define UIR_IDLEIF 0x10
#define UIR_TRNIF 0x08
#define UIR_ACTVIF 0x04
#define UIR_URSTIF 0x01

#define USTAT_EP0_OUT (0 << 3)
#define USTAT_EP0_IN (0 << 3 | 0x04)
#define USTAT_EP1_IN (1 << 3 | 0x04)
#define USTAT_EP2_OUT (2 << 3)
#define USTAT_EP2_IN (2 << 3 | 0x04)
#define USTAT_MASK 0x7C
#define USTAT_DEPTH 4

#define UEP_EPHSHK 0x10
#define UEP_EPCONDIS 0x08
#define UEP_EPOUTEN 0x04
#define UEP_EPINEN 0x02
#define UEP_EPSTALL 0x01

/* BDnSTAT. */
#define BD_UOWN 0x80
#define BD_DTS 0x40
#define BD_DTSEN 0x08
#define BD_BSTALL 0x04
#define BD_PID 0x3C
#define BD_PID_SETUP (0x0D << 2)

#define PIR2_USBIF 0x20
#define PIE2_USBIE 0x20
#define IPR2_USBIP 0x20

/* ---- Memory ------------------------------------------------------------- */
#define EP0_SIZE 16
#define EP1_SIZE 16
#define EP2_SIZE 64

struct buffer_descriptor {
    uint8_t stat; /* written last: UOWN hands the buffer over */
    uint8_t cnt;
    uint8_t adrl;
    uint8_t adrh;
};

#define BD_EP0_OUT 0
#define BD_EP0_IN 1
#define BD_EP1_IN 3
#define BD_EP2_OUT 4
#define BD_EP2_IN 5
#define BD_COUNT 6

#define USB_SERIAL_DESCRIPTOR_LENGTH 18
#define LINE_CODING_LENGTH 7

extern volatile struct buffer_descriptor usb_bd[BD_COUNT];
extern volatile uint8_t usb_ep0_out[EP0_SIZE];
extern volatile uint8_t usb_ep0_in[EP0_SIZE];
extern volatile uint8_t usb_ep1_in[EP1_SIZE];
extern volatile uint8_t usb_line_coding[LINE_CODING_LENGTH];

/* Device states of USB 2.0, section 9.1. Suspended is the bit SUSPND in UCON
 * beside any of them. */
#define USB_DETACHED 0
#define USB_DEFAULT 1
#define USB_ADDRESS 2
#define USB_CONFIGURED 3

/* One bit per endpoint in `halted`, `armed` and `toggle`. */
#define EP1_IN_BIT 0x01
#define EP2_OUT_BIT 0x02
#define EP2_IN_BIT 0x04
#define EP_ALL_BITS 0x07

/* The driver's variables. Not a struct: SDCC tests single bits of a struct
 * member in the wrong bank. */
extern volatile uint8_t usb_state;       /* USB_DETACHED ... */
extern volatile uint8_t usb_vbus_ms;     /* VBUS disagrees with it for, ms */
extern volatile uint8_t usb_new_address; /* until the status stage, 0xFF none */
extern volatile uint8_t usb_stage;       /* of the control transfer */
extern volatile uint8_t usb_source;      /* of its data, SOURCE_... */
extern volatile uint8_t usb_left;        /* bytes of it still to send */
extern volatile uint8_t usb_ends_short;  /* a short packet is still due */
extern volatile uint8_t usb_in_stat;     /* BDnSTAT of the last EP0 IN */
extern volatile uint16_t usb_next;       /* address of the next byte to send */
extern volatile uint8_t usb_halted;      /* endpoints with ENDPOINT_HALT */
extern volatile uint8_t usb_armed;       /* endpoints the engine owns */
extern volatile uint8_t usb_toggle;      /* set = next packet is DATA1 */
extern volatile uint8_t usb_notify;      /* SERIAL_STATE waits to be sent */
extern volatile uint8_t usb_line_state;  /* bit 0 DTR, bit 1 RTS */

/* Notes between the main loop and the interrupt, see cdc.c. */
extern volatile uint8_t usb_received; /* bytes in cdc_packet; main clears */
extern volatile uint8_t usb_sending;  /* bytes of cdc_reply; main sets */

/* Where the data stage of a control read comes from (usb_source). */
#define SOURCE_BUFFER 0 /* already in usb_ep0_in */
#define SOURCE_FLASH 1  /* a table at usb_next */
#define SOURCE_RAM 2    /* bytes in RAM at usb_next */

/* Stages of a control transfer (usb_stage). */
#define STAGE_IDLE 0      /* next is a SETUP */
#define STAGE_DATA_IN 1   /* data to the host; its OUT ends the transfer */
#define STAGE_DATA_OUT 2  /* data from the host */
#define STAGE_STATUS_IN 3 /* our empty packet ends the transfer */

/* ---- control.c: endpoint 0, transfers ----------------------------------- */
void control_reset(void); /* forget the transfer, wait for a SETUP */
void control_setup(void); /* a SETUP has arrived; PKTDIS is set */
void control_out(void);   /* an OUT transaction has ended */
void control_in(void);    /* an IN transaction has ended */

/* ---- chapter9.c: standard requests --------------------------------------
 * Carries out the standard request in usb_ep0_out. 1 = done; for a request
 * with data to the host usb_left, usb_source and usb_next say which. 0 = not
 * supported, to be stalled; nothing has changed then.
 */
uint8_t standard_request(void);

/* ---- cdc.c: endpoints 1 and 2, class requests --------------------------- */
void cdc_line_coding_default(void);
void cdc_reset(void);              /* endpoints off, nothing pending */
void cdc_configure(void);          /* after cdc_reset(): endpoints on, DATA0 */
void cdc_transaction(uint8_t bit); /* a transaction of this endpoint ended */
void cdc_pump(void);               /* arm what can be armed */
uint8_t cdc_request(void);         /* class request, as above */

/* Takes the endpoints `bits` back from the engine, while PKTDIS is set, and
 * begins anew with DATA0: stat = 0 without a halt, BD_HALT halted. Halted
 * descriptors hold no bytes, so the buffers stay free for the main loop. */
void cdc_restart(uint8_t bits, uint8_t stat);
#define BD_HALT (BD_UOWN | BD_BSTALL)

/* ---- memory.asm --------------------------------------------------------
 * Writes the address of each buffer into its descriptor.
 */
void usb_set_up_descriptors(void);

/* ---- copy.asm -----------------------------------------------------------
 * Both copy `count` bytes, at least 1, and need about 50 cycles beside those
 * for each byte: 5 in RAM, 7 from flash. usb_copy_flash() copies to usb_ep0_in
 * (so at most 16) and leaves table pointer and TABLAT as they were; so it may
 * interrupt a reader of flash.
 */
void usb_copy(volatile __data uint8_t *to, volatile __data uint8_t *from,
              uint8_t count);
void usb_copy_flash(uint16_t address, uint8_t count);

#endif
