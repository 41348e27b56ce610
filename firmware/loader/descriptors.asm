; Boot loader: what it tells of itself, and which request asks for what.
; SPDX-License-Identifier: Apache-2.0
;
; A serial port without a driver to install, for the same reasons as the
; lathe's own (usb/descriptors.c); 1209:0002 is the next of the open test ids,
; so that nobody takes one for the other.

        include "loader.inc"

        global  reads

; All in one page: `source_low` is all that a read keeps. A line of db is filled
; up to an even number of bytes, so each but the last of a descriptor has one.
loader_tables   code    0x000700

; bmRequestType, bRequest, wValue low, high; place, length of the answer
read    macro   type, request, low_value, high_value, place, length
        db      type, request, low_value, high_value, LOW (place), length
        endm
reads:
        read    0x80, 6, 0, 1, device, 18
        read    0x80, 6, 0, 2, configuration, 67
        read    0x80, 6, 0, 3, languages, 4
        read    0x80, 6, 1, 3, vendor, 18
        read    0x80, 6, 2, 3, product, 32
        read    0x80, 8, 0, 0, numbers, 1       ; plus 1 when configured
        read    0x80, 0, 0, 0, numbers + 1, 2   ; powered by the lathe
        read    0x81, 0, 0, 0, numbers + 2, 2
        read    0x82, 0, 0, 0, numbers + 2, 2
        read    0x81, 10, 0, 0, numbers, 1
        read    0xA1, 0x21, 0, 0, coding, 7

numbers:
        db      0, 1, 0, 0
device:
        db      18, 1, 0x00, 0x02, 2, 2, 0, EP0_SIZE
        db      0x09, 0x12, 0x02, 0x00, LOADER_VERSION, 0, 1, 2, 0, 1
configuration:
        db      9, 2, 67, 0, 2, 1, 0, 0xC0, 50, 9, 4, 0, 0, 1, 2, 2, 0, 0
        db      5, 0x24, 0, 0x20, 0x01, 5, 0x24, 1, 0, 1
        db      4, 0x24, 2, 2
        db      5, 0x24, 6, 0, 1, 7, 5, 0x81, 3, 16, 0, 100
        db      9, 4, 1, 0, 2, 10, 0, 0, 0, 7, 5, 0x02, 2, BULK_SIZE, 0, 0
        db      7, 5, 0x82, 2, BULK_SIZE, 0, 0
languages:
        db      4, 3, 0x09, 0x04
vendor:
        db      18, 3, 'T', 0, 'o', 0, 'r', 0, 'n', 0
        db      'i', 0, 'l', 0, 'l', 0, 'o', 0
product:
        db      32, 3, 'T', 0, 'o', 0, 'r', 0, 'n', 0
        db      'i', 0, 'l', 0, 'l', 0, 'o', 0, ' ', 0
        db      'l', 0, 'o', 0, 'a', 0, 'd', 0, 'e', 0, 'r', 0
coding:                                 ; 115,200 baud, 8N1: nobody minds
        db      0x00, 0xC2, 0x01, 0x00, 0, 0, 8
        end
