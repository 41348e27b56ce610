/* The standard requests of USB 2.0, chapter 9.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * The SETUP packet is in usb_ep0_out, PKTDIS is set. What a request may do
 * depends on the device state (table in section 9.4): before an address and a
 * configuration are set, only endpoint 0 and no interface exists. Anything
 * that is not written here is refused, which endpoint 0 turns into a STALL.
 */
#include "usb/descriptors.h"
#include "usb/engine.h"
#include "usb/usb_config.h"
#include "usb/cdc.h"
#include "sfr.h"

#define REFUSED 0
#define DONE 1

#define SETUP_TYPE usb_ep0_out[0]
#define SETUP_REQUEST usb_ep0_out[1]
#define SETUP_VALUE_LOW usb_ep0_out[2]
#define SETUP_VALUE_HIGH usb_ep0_out[3]
#define SETUP_INDEX_LOW usb_ep0_out[4]
#define SETUP_INDEX_HIGH usb_ep0_out[5]
#define SETUP_LENGTH_LOW usb_ep0_out[6]
#define SETUP_LENGTH_HIGH usb_ep0_out[7]

/* bmRequestType: direction and recipient. */
#define TO_DEVICE 0x00
#define TO_INTERFACE 0x01
#define TO_ENDPOINT 0x02
#define FROM_DEVICE 0x80
#define FROM_INTERFACE 0x81
#define FROM_ENDPOINT 0x82

/* bRequest. */
#define GET_STATUS 0
#define CLEAR_FEATURE 1
#define SET_FEATURE 3
#define SET_ADDRESS 5
#define GET_DESCRIPTOR 6
#define GET_CONFIGURATION 8
#define SET_CONFIGURATION 9
#define GET_INTERFACE 10
#define SET_INTERFACE 11

#define FEATURE_ENDPOINT_HALT 0

#define DESCRIPTOR_DEVICE 1
#define DESCRIPTOR_CONFIGURATION 2
#define DESCRIPTOR_STRING 3

#define ADDRESS_MAX 127

/* Beside EP1_IN_BIT ... in what endpoint() returns. */
#define EP0_BIT 0x80

/* The endpoint in wIndex as a bit; 0 = there is none of this address now. */
static uint8_t endpoint(void)
{
    uint8_t address = SETUP_INDEX_LOW;

    if (SETUP_INDEX_HIGH) {
        return 0;
    }
    if (address == 0x00 || address == 0x80) {
        return EP0_BIT;
    }
    if (usb_state != USB_CONFIGURED) {
        return 0;
    }
    if (address == 0x81) {
        return EP1_IN_BIT;
    }
    if (address == 0x02) {
        return EP2_OUT_BIT;
    }
    if (address == 0x82) {
        return EP2_IN_BIT;
    }
    return 0;
}

/* 1 = the interface in wIndex exists now. */
static uint8_t is_interface(void)
{
    if (usb_state != USB_CONFIGURED || SETUP_INDEX_HIGH) {
        return 0;
    }
    return SETUP_INDEX_LOW < 2;
}

static uint8_t get_status(void)
{
    uint8_t type = SETUP_TYPE;
    uint8_t status = 0;
    uint8_t bits;

    if (type == FROM_DEVICE) {
        status = USB_SELF_POWERED;
    } else if (type == FROM_INTERFACE) {
        if (!is_interface()) {
            return REFUSED;
        }
    } else if (type == FROM_ENDPOINT) {
        bits = endpoint();
        if (!bits) {
            return REFUSED;
        }
        if (usb_halted & bits) {
            status = 1;
        }
    } else {
        return REFUSED;
    }
    usb_ep0_in[0] = status;
    usb_ep0_in[1] = 0;
    usb_left = 2;
    return DONE;
}

/* The only feature here is ENDPOINT_HALT. Endpoint 0 is never halted, so
 * clearing it is done already and setting it is refused. */
static uint8_t change_feature(void)
{
    uint8_t bits = endpoint();

    if (SETUP_TYPE != TO_ENDPOINT || SETUP_LENGTH_LOW || SETUP_LENGTH_HIGH) {
        return REFUSED;
    }
    if (SETUP_VALUE_HIGH || SETUP_VALUE_LOW != FEATURE_ENDPOINT_HALT) {
        return REFUSED;
    }
    if (SETUP_REQUEST == SET_FEATURE) {
        bits &= EP_ALL_BITS;
        cdc_restart(bits, BD_HALT);
    } else {
        cdc_restart(bits, 0);
    }
    return bits;
}

static uint8_t set_address(void)
{
    if (SETUP_VALUE_HIGH || SETUP_VALUE_LOW > ADDRESS_MAX) {
        return REFUSED;
    }
    if (usb_state == USB_CONFIGURED) {
        return REFUSED;
    }
    usb_new_address = SETUP_VALUE_LOW;
    return DONE;
}

/* A full-speed device has no device qualifier: refused, as 9.6.2 asks for. */
static uint8_t get_descriptor(void)
{
    uint8_t type = SETUP_VALUE_HIGH;
    uint8_t index = SETUP_VALUE_LOW;

    usb_source = SOURCE_FLASH;
    if (type == DESCRIPTOR_STRING) {
        if (index == STRING_LANGUAGES) {
            usb_next = (uint16_t)string_languages;
            usb_left = STRING_LANGUAGES_LENGTH;
        } else if (index == STRING_VENDOR) {
            usb_next = (uint16_t)string_vendor;
            usb_left = STRING_VENDOR_LENGTH;
        } else if (index == STRING_PRODUCT) {
            usb_next = (uint16_t)string_product;
            usb_left = STRING_PRODUCT_LENGTH;
        } else if (index == STRING_SERIAL) {
            usb_source = SOURCE_RAM;
            usb_next = (uint16_t)usb_serial_descriptor;
            usb_left = USB_SERIAL_DESCRIPTOR_LENGTH;
        }
    } else if (!index) {
        if (type == DESCRIPTOR_DEVICE) {
            usb_next = (uint16_t)device_descriptor;
            usb_left = DEVICE_DESCRIPTOR_LENGTH;
        } else if (type == DESCRIPTOR_CONFIGURATION) {
            usb_next = (uint16_t)configuration_descriptor;
            usb_left = CONFIGURATION_DESCRIPTOR_LENGTH;
        }
    }
    return usb_left; /* 0 = none of these */
}

static uint8_t set_configuration(void)
{
    if (usb_state == USB_DEFAULT || SETUP_VALUE_HIGH) {
        return REFUSED;
    }
    if (SETUP_VALUE_LOW > 1) {
        return REFUSED;
    }
    UEP1 = 0;
    UEP2 = 0;
    cdc_reset();
    usb_state = USB_ADDRESS;
    if (SETUP_VALUE_LOW) {
        usb_state = USB_CONFIGURED;
        cdc_configure();
    }
    return DONE;
}

/* There is only setting 0, but to select it resets the interface's endpoints
 * (9.1.1.5). */
static uint8_t set_interface(void)
{
    if (!is_interface() || SETUP_VALUE_LOW || SETUP_VALUE_HIGH) {
        return REFUSED;
    }
    if (SETUP_INDEX_LOW) {
        cdc_restart(EP2_OUT_BIT | EP2_IN_BIT, 0);
    } else {
        cdc_restart(EP1_IN_BIT, 0);
    }
    return DONE;
}

/* Data of one byte, 0 or 1. */
static uint8_t send_flag(uint8_t flag)
{
    usb_ep0_in[0] = flag;
    usb_left = 1;
    return DONE;
}

uint8_t standard_request(void)
{
    uint8_t request = SETUP_REQUEST;
    uint8_t type = SETUP_TYPE;

    if (request == GET_STATUS) {
        return get_status();
    }
    if (request == CLEAR_FEATURE || request == SET_FEATURE) {
        return change_feature();
    }
    if (type == FROM_DEVICE) {
        if (request == GET_DESCRIPTOR) {
            return get_descriptor();
        }
        if (request == GET_CONFIGURATION) {
            return send_flag(usb_state == USB_CONFIGURED);
        }
        return REFUSED;
    }
    if (type == FROM_INTERFACE) {
        if (request == GET_INTERFACE && is_interface()) {
            return send_flag(0);
        }
        return REFUSED;
    }
    if (SETUP_LENGTH_LOW || SETUP_LENGTH_HIGH) {
        return REFUSED; /* SET_DESCRIPTOR would be the only one */
    }
    if (type == TO_INTERFACE && request == SET_INTERFACE) {
        return set_interface();
    }
    if (type != TO_DEVICE) {
        return REFUSED;
    }
    if (request == SET_ADDRESS) {
        return set_address();
    }
    if (request == SET_CONFIGURATION) {
        return set_configuration();
    }
    return REFUSED;
}
