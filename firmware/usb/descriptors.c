/* The descriptors of the device: who it is and which endpoints it has.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Chosen so that a serial port appears without any driver to install:
 *  - Windows 10 and later load usbser.sys for class 2, subclass 2 in the
 *    *device* descriptor. Linux (cdc-acm) and macOS look at the interfaces.
 *  - One function with two interfaces needs no interface association.
 *  - Protocol 0 of the control interface ("no class specific protocol") is the
 *    truth: there are no AT commands here. Modem daemons leave such a port
 *    alone; protocol 1 would invite them to talk to the lathe.
 */
#include "usb/descriptors.h"

#include "usb/engine.h"
#include "usb/usb_config.h"

#define LOW_BYTE(word) ((word)&0xFF)
#define HIGH_BYTE(word) ((word) >> 8)

/* Descriptor types: USB 2.0 table 9-5, CDC 1.2 table 12. */
#define TYPE_DEVICE 1
#define TYPE_CONFIGURATION 2
#define TYPE_STRING 3
#define TYPE_INTERFACE 4
#define TYPE_ENDPOINT 5
#define TYPE_CS_INTERFACE 0x24

#define CLASS_COMMUNICATIONS 0x02
#define CLASS_CDC_DATA 0x0A
#define SUBCLASS_ACM 0x02
#define PROTOCOL_NONE 0x00

/* bmAttributes: bit 7 is always one, bit 6 = has a supply of its own, bit 5 =
 * remote wake-up, which a lathe has no use for. */
#define CONFIGURATION_ATTRIBUTES (0x80 | USB_SELF_POWERED << 6)

/* One field or one group of fields a line, as the specifications print them. */
/* clang-format off */
__code const uint8_t device_descriptor[DEVICE_DESCRIPTOR_LENGTH] = {
    DEVICE_DESCRIPTOR_LENGTH,
    TYPE_DEVICE,
    0x00, 0x02, /* USB 2.00 */
    CLASS_COMMUNICATIONS,
    SUBCLASS_ACM,
    PROTOCOL_NONE,
    EP0_SIZE,
    LOW_BYTE(USB_VENDOR_ID), HIGH_BYTE(USB_VENDOR_ID),
    LOW_BYTE(USB_PRODUCT_ID), HIGH_BYTE(USB_PRODUCT_ID),
    LOW_BYTE(USB_DEVICE_RELEASE_BCD), HIGH_BYTE(USB_DEVICE_RELEASE_BCD),
    STRING_VENDOR,
    STRING_PRODUCT,
    STRING_SERIAL,
    1, /* configurations */
};

__code const uint8_t
    configuration_descriptor[CONFIGURATION_DESCRIPTOR_LENGTH] = {
    9, TYPE_CONFIGURATION,
    CONFIGURATION_DESCRIPTOR_LENGTH, 0, /* with all that follows */
    2,                                  /* interfaces */
    1,                                  /* value for SET_CONFIGURATION */
    0,                                  /* no name */
    CONFIGURATION_ATTRIBUTES,
    USB_BUS_CURRENT_MA / 2,

    /* Interface 0: control of the serial port. */
    9, TYPE_INTERFACE, 0, 0, 1,
    CLASS_COMMUNICATIONS, SUBCLASS_ACM, PROTOCOL_NONE, 0,
    5, TYPE_CS_INTERFACE, 0x00, 0x20, 0x01, /* header: CDC 1.20 */
    5, TYPE_CS_INTERFACE, 0x01, 0x00, 1,    /* call management: none */
    4, TYPE_CS_INTERFACE, 0x02, 0x06, /* ACM: line requests and break */
    5, TYPE_CS_INTERFACE, 0x06, 0, 1, /* union: 0 controls 1 */
    7, TYPE_ENDPOINT, 0x81, 0x03, EP1_SIZE, 0,
    100, /* asked every 100 ms; the only news is at the start */

    /* Interface 1: the bytes. */
    9, TYPE_INTERFACE, 1, 0, 2, CLASS_CDC_DATA, 0, PROTOCOL_NONE, 0,
    7, TYPE_ENDPOINT, 0x02, 0x02, EP2_SIZE, 0, 0,
    7, TYPE_ENDPOINT, 0x82, 0x02, EP2_SIZE, 0, 0,
};

__code const uint8_t string_languages[STRING_LANGUAGES_LENGTH] = {
    STRING_LANGUAGES_LENGTH, TYPE_STRING, 0x09, 0x04, /* English (US) */
};

__code const uint8_t string_vendor[STRING_VENDOR_LENGTH] = {
    STRING_VENDOR_LENGTH, TYPE_STRING,
    'T', 0, 'o', 0, 'r', 0, 'n', 0, 'i', 0, 'l', 0, 'l', 0, 'o', 0,
};

__code const uint8_t string_product[STRING_PRODUCT_LENGTH] = {
    STRING_PRODUCT_LENGTH, TYPE_STRING,
    'T', 0, 'o', 0, 'r', 0, 'n', 0, 'i', 0, 'l', 0, 'l', 0, 'o', 0,
    ' ', 0, 'l', 0, 'a', 0, 't', 0, 'h', 0, 'e', 0,
};
/* clang-format on */
