; Copies a piece of a table in flash to the buffer of endpoint 0 IN.
;
; SPDX-License-Identifier: Apache-2.0
;
; void usb_fetch(uint16_t address, uint8_t count);    (manual: engine.h)
;
; SDCC's calling convention for this port: arguments on the software stack, the
; first nearest to FSR1, so address low is at FSR1+1, high at +2, count at +3.
; FSR0 and PROD are free for the callee. 7 cycles per byte + 38.
;
; The main loop may be in the middle of a table read of its own when the
; interrupt that calls this arrives, so the table pointer and TABLAT are put
; back as they were.

        include <p18f4550.inc>
        radix   dec

        global  _usb_fetch
        extern  _usb_ep0_in

usb_fetch_code  code
_usb_fetch:
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
next:
        tblrd   *+
        movff   TABLAT, POSTINC0
        decfsz  PRODL, F, ACCESS
        bra     next

        movff   PREINC1, TABLAT
        movff   PREINC1, TBLPTRU
        movff   PREINC1, TBLPTRH
        movff   PREINC1, TBLPTRL
        return

        end
