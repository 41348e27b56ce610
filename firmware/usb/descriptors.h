/* The descriptors of the device, as tables in flash.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef USB_DESCRIPTORS_H
#define USB_DESCRIPTORS_H

#include <stdint.h>

#define DEVICE_DESCRIPTOR_LENGTH 18
#define CONFIGURATION_DESCRIPTOR_LENGTH 67
#define STRING_LANGUAGES_LENGTH 4
#define STRING_VENDOR_LENGTH (2 + 2 * 8)
#define STRING_PRODUCT_LENGTH (2 + 2 * 14)
#define SERIAL_STATE_LENGTH 10

/* String indices as the device descriptor names them. */
#define STRING_LANGUAGES 0
#define STRING_VENDOR 1
#define STRING_PRODUCT 2
#define STRING_SERIAL 3

extern __code const uint8_t device_descriptor[DEVICE_DESCRIPTOR_LENGTH];
extern __code const uint8_t
    configuration_descriptor[CONFIGURATION_DESCRIPTOR_LENGTH];
extern __code const uint8_t string_languages[STRING_LANGUAGES_LENGTH];
extern __code const uint8_t string_vendor[STRING_VENDOR_LENGTH];
extern __code const uint8_t string_product[STRING_PRODUCT_LENGTH];

#endif
