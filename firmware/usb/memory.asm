; The RAM of the USB driver: the map of 0x400..0x4FF.
;
; SPDX-License-Identifier: Apache-2.0
;
; The serial interface engine finds its buffer descriptors at 0x400, by
; hardware; the buffers follow, then what is left is used for the driver's own
; variables. What each is for is said in engine.h and cdc.h. In assembly because
; SDCC loses variables with fixed addresses that touch each other.

        include <p18f4550.inc>
        radix   dec

        global  _usb_set_up_descriptors
        global  _usb_bd, _usb_ep0_out, _usb_ep0_in, _usb_ep1_in
        global  _cdc_packet, _cdc_reply
        global  _usb_serial_descriptor, _usb_line_coding
        global  _usb_state, _usb_vbus_ms, _usb_new_address, _usb_stage
        global  _usb_source, _usb_left, _usb_ends_short, _usb_in_stat
        global  _usb_next, _usb_halted, _usb_armed, _usb_toggle
        global  _usb_notify, _usb_line_state, _usb_received, _usb_sending

usb_memory      udata   0x400
_usb_bd                 res     24      ; EP0 OUT, IN, EP1 OUT, IN, EP2 OUT, IN
_usb_ep0_out            res     16      ; 0x418
_usb_ep0_in             res     16      ; 0x428
_usb_ep1_in             res     16      ; 0x438
_cdc_packet             res     64      ; 0x448, EP2 OUT
_cdc_reply              res     64      ; 0x488, EP2 IN
_usb_serial_descriptor  res     18      ; 0x4C8
_usb_line_coding        res     7       ; 0x4DA

_usb_state              res     1       ; 0x4E1
_usb_vbus_ms            res     1
_usb_new_address        res     1
_usb_stage              res     1
_usb_source             res     1
_usb_left               res     1
_usb_ends_short         res     1
_usb_in_stat            res     1
_usb_next               res     2
_usb_halted             res     1
_usb_armed              res     1
_usb_toggle             res     1
_usb_notify             res     1
_usb_line_state         res     1
_usb_received           res     1
_usb_sending            res     1       ; 0x4F1; 14 bytes to 0x4FF are free

; ADRL and ADRH of the buffer descriptor `index`.
buffer  macro   index, address
        movlw   LOW (address)
        movwf   _usb_bd + 4 * index + 2, BANKED
        movlw   HIGH (address)
        movwf   _usb_bd + 4 * index + 3, BANKED
        endm

; void usb_set_up_descriptors(void);    (manual: engine.h)
usb_memory_code code
_usb_set_up_descriptors:
        banksel _usb_bd
        buffer  0, _usb_ep0_out
        buffer  1, _usb_ep0_in
        buffer  3, _usb_ep1_in
        buffer  4, _cdc_packet
        buffer  5, _cdc_reply
        return

        end
