; Reads the serial number from EEPROM into the string descriptor.
;
; SPDX-License-Identifier: Apache-2.0
;
; void usb_read_serial_number(void);    (manual: cdc.h)
;
; In assembly because SDCC needs three times the bytes for it. FSR0 is free for
; the callee; all other registers here are in the access bank.

        include <p18f4550.inc>
        radix   dec

        global  _usb_read_serial_number
        extern  _usb_serial_descriptor

SERIAL_AT       equ     0xF0            ; EEPROM_SERIAL in store/eeprom.h
SERIAL_END_BIT  equ     3               ; of EEADR, set behind the 8th character
LENGTH          equ     18              ; of the descriptor
TYPE_STRING     equ     3
PLACEHOLDER     equ     '0'

serial_number_code code
_usb_read_serial_number:
        lfsr    FSR0, _usb_serial_descriptor
        movlw   LENGTH
        movwf   POSTINC0, ACCESS
        movlw   TYPE_STRING
        movwf   POSTINC0, ACCESS
        movlw   SERIAL_AT
        movwf   EEADR, ACCESS
next_character:
        clrf    EECON1, ACCESS
        bsf     EECON1, RD, ACCESS      ; the byte is there in the next cycle
        movf    EEDATA, W, ACCESS
        xorlw   ','                     ; Windows refuses it
        bz      refused
        movlw   0x7F
        subwf   EEDATA, W, ACCESS
        bc      refused
        movlw   0x21
        subwf   EEDATA, W, ACCESS
        movf    EEDATA, W, ACCESS       ; leaves the carry alone
        bc      accepted
refused:
        movlw   PLACEHOLDER
accepted:
        movwf   POSTINC0, ACCESS
        clrf    POSTINC0, ACCESS        ; UTF-16
        incf    EEADR, F, ACCESS
        btfss   EEADR, SERIAL_END_BIT, ACCESS
        bra     next_character
        return

        end
