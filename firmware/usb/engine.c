/* The serial interface engine: cable, bus reset, suspend, and who gets which
 * transaction.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * States (USB 2.0, section 9.1):
 *
 *    DETACHED --VBUS for 50 ms--> DEFAULT --SET_ADDRESS--> ADDRESS
 *        ^                         ^                         |  ^
 *        |                         |            SET_CONFIGURATION(1) (0)
 *        |                     bus reset                     v  |
 *        +--no VBUS for 5 ms--  from any                  CONFIGURED
 *
 * Attached, powered and default are one state here: before the first bus
 * reset no transaction can reach us. The engine takes the first reset itself
 * as an interrupt; nothing waits for the bus to become quiet.
 */
#include "usb/engine.h"

#include "usb/cdc.h"
#include "sfr.h"
#include "usb/usb_config.h"

/* The engine off and everything as after power-on. */
static void detach(void)
{
    UCON = 0;
    UIE = 0;
    UIR = 0;
    usb_state = USB_DETACHED;
    usb_vbus_ms = 0;
    cdc_reset();
}

/* Pull-up on D+: from now on the host sees a full-speed device. */
static void attach(void)
{
    UCFG = UCFG_UPUEN | UCFG_FSEN;
    UIR = 0;
    UEIE = 0;
    UIE = UIR_URSTIF | UIR_TRNIF | UIR_IDLEIF | UIR_STALLIF;
    usb_state = USB_DEFAULT;
    usb_vbus_ms = 0;
    UCON = UCON_USBEN;
}

void usb_init(void)
{
    UCON = 0;
    usb_read_serial_number();
    usb_set_up_descriptors();
    usb_received = 0;
    detach();
    cdc_line_coding_default();
    IPR2 &= (uint8_t)~IPR2_USBIP;
    PIE2 |= PIE2_USBIE;
}

/* Bus reset: address 0, only endpoint 0, nothing left of what was. */
static void bus_reset(void)
{
    uint8_t i;

    UADDR = 0;
    UEP0 = 0;
    UEP1 = 0;
    UEP2 = 0;
    usb_state = USB_DEFAULT;
    /* Transactions of the time before the reset are of no interest. The next
     * one shows up 6 cycles after clearing TRNIF: cdc_reset() takes longer. */
    for (i = 0; i < USTAT_DEPTH; i++) {
        UIR &= (uint8_t)~UIR_TRNIF;
        cdc_reset();
    }
    control_reset();
    UEP0 = UEP_EPHSHK | UEP_EPOUTEN | UEP_EPINEN;
    UIE &= (uint8_t)~UIR_ACTVIF;
    UCON = UCON_USBEN; /* PKTDIS and SUSPND off */
    UIR &= (uint8_t)~UIR_URSTIF;
}

/* 3 ms without traffic. The chip goes on cutting; only the transceiver sleeps
 * until the bus moves. */
static void suspend(void)
{
    UIR &= (uint8_t)~UIR_IDLEIF;
    UIR &= (uint8_t)~UIR_ACTVIF;
    UIE |= UIR_ACTVIF;
    UCON |= UCON_SUSPND;
}

/* Traffic again. ACTVIF cannot be cleared before the engine's clock has come
 * back; as its interrupt is off until the next suspend nobody has to wait. */
static void resume(void)
{
    UCON &= (uint8_t)~UCON_SUSPND;
    UIE &= (uint8_t)~UIR_ACTVIF;
    UIR &= (uint8_t)~UIR_ACTVIF;
}

void usb_service(void)
{
    uint8_t flags;
    uint8_t ustat;
    uint8_t pid;

    /* First, so that whatever happens from here on raises it again. */
    PIR2 &= (uint8_t)~PIR2_USBIF;

    flags = UIR & UIE;
    if (flags & UIR_ACTVIF) {
        resume();
    }
    if (flags & UIR_URSTIF) {
        bus_reset();
        return;
    }
    if (flags & UIR_IDLEIF) {
        suspend();
    }
    if (flags & UIR_STALLIF) {
        /* The stall itself stays in the buffer descriptor. The flag goes first:
         * another stall in between raises it again. */
        UIR &= (uint8_t)~UIR_STALLIF;
        UEP0 &= (uint8_t)~UEP_EPSTALL;
        UEP1 &= (uint8_t)~UEP_EPSTALL;
        UEP2 &= (uint8_t)~UEP_EPSTALL;
    }
    if (flags & UIR_TRNIF) {
        /* The oldest transaction of the FIFO; its descriptor is ours again.
         * Clearing TRNIF brings up the next one. */
        ustat = USTAT & USTAT_MASK;
        UIR &= (uint8_t)~UIR_TRNIF;
        if (ustat == USTAT_EP0_OUT) {
            pid = usb_bd[BD_EP0_OUT].stat & BD_PID;
            if (pid == BD_PID_SETUP) {
                control_setup();
            } else {
                control_out();
            }
        } else if (ustat == USTAT_EP0_IN) {
            control_in();
        } else if (ustat == USTAT_EP2_OUT) {
            cdc_transaction(EP2_OUT_BIT);
        } else if (ustat == USTAT_EP2_IN) {
            cdc_transaction(EP2_IN_BIT);
        } else {
            cdc_transaction(EP1_IN_BIT);
        }
    }
    cdc_pump();
}

void usb_tick(void)
{
    uint8_t vbus = USB_VBUS_PORT & USB_VBUS_MASK;

    if (usb_state == USB_DETACHED) {
        if (!vbus) {
            usb_vbus_ms = 0;
        } else if (++usb_vbus_ms == USB_ATTACH_MS) {
            attach();
        }
    } else {
        if (vbus) {
            usb_vbus_ms = 0;
        } else if (++usb_vbus_ms == USB_DETACH_MS) {
            detach();
        }
    }
    /* A net under the interrupt: a flag that is up gets served. */
    if (UIR & UIE) {
        PIR2 |= PIR2_USBIF;
    }
}
