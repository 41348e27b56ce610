; Copies bytes: from RAM to RAM, and from flash to the buffer of EP0 IN.
;
; SPDX-License-Identifier: Apache-2.0
;
; void usb_copy(volatile __data uint8_t *to, volatile __data uint8_t *from,
;               uint8_t count);
; void usb_copy_flash(uint16_t address, uint8_t count);    (manual: engine.h)
;
; SDCC's calling convention for this port: arguments on the software stack, the
; first nearest to FSR1 and its low byte first. FSR0 and PROD are free for the
; callee, FSR2 is not. In assembly because SDCC needs 35 cycles for a byte, and
; these loops run in the interrupt.

        include <p18f4550.inc>
        radix   dec

        global  _usb_copy, _usb_copy_flash
        extern  _usb_ep0_in

usb_copy_code   code
_usb_copy:
        movff   FSR2L, POSTDEC1
        movff   FSR2H, POSTDEC1         ; the arguments are 2 further away now
        movlw   3
        movff   PLUSW1, FSR0L
        movlw   4
        movff   PLUSW1, FSR0H
        movlw   5
        movff   PLUSW1, FSR2L
        movlw   6
        movff   PLUSW1, FSR2H
        movlw   7
        movff   PLUSW1, PRODL           ; count
next:
        movff   POSTINC2, POSTINC0
        decfsz  PRODL, F, ACCESS
        bra     next
        movff   PREINC1, FSR2H
        movff   PREINC1, FSR2L
        return

; The main loop may be in the middle of a table read of its own when the
; interrupt that calls this arrives, so the table pointer and TABLAT are put
; back as they were.
_usb_copy_flash:
        movff   TBLPTRL, POSTDEC1
        movff   TBLPTRH, POSTDEC1
        movff   TBLPTRU, POSTDEC1
        movff   TABLAT, POSTDEC1        ; the arguments are 4 further away now
        movlw   5
        movff   PLUSW1, TBLPTRL
        movlw   6
        movff   PLUSW1, TBLPTRH
        clrf    TBLPTRU, ACCESS
        movlw   7
        movff   PLUSW1, PRODL           ; count

        lfsr    FSR0, _usb_ep0_in
next_of_flash:
        tblrd   *+
        movff   TABLAT, POSTINC0
        decfsz  PRODL, F, ACCESS
        bra     next_of_flash

        movff   PREINC1, TABLAT
        movff   PREINC1, TBLPTRU
        movff   PREINC1, TBLPTRH
        movff   PREINC1, TBLPTRL
        return

        end
