; CRC-16/CCITT-FALSE without a table: of one more byte, and of a block.
;
; SPDX-License-Identifier: Apache-2.0
;
; uint16_t crc16_update(uint16_t crc, uint8_t byte);    (manual: crc.h)
; uint16_t crc16_block(uint16_t crc, __data const uint8_t *data,
;                      uint8_t length);
;
; Shifting eight bits through x^16 + x^12 + x^5 + 1 at once comes down to
;       x    = (crc >> 8) ^ byte
;       x   ^= x >> 4
;       crc  = (crc << 8) ^ (x << 12) ^ (x << 5) ^ x
; and the hardware multiplier makes x << 5 in one cycle: x * 32 leaves x >> 3 in
; PRODH and the low byte of x << 5 in PRODL.
;
; SDCC's calling convention for this port: arguments on the software stack, the
; first nearest to FSR1 and its low byte first; the result is in PRODL:WREG.
; FSR0 and PROD are free for the callee.

        include <p18f4550.inc>
        radix   dec

        global  _crc16_update, _crc16_block

crc_access      udata_acs
crc_low         res     1
crc_high        res     1
folded          res     1               ; x
left            res     1

; ---- one byte ---------------------------------------------------------------
; crc low at FSR1+1, high at +2, byte at +3. 29 cycles with CALL and RETURN. x
; lives in FSR0L (FSR0H has only four bits).
crc_code        code
_crc16_update:
        movlw   3
        movff   PLUSW1, FSR0L
        movlw   2
        movf    PLUSW1, W, ACCESS       ; crc high
        xorwf   FSR0L, F, ACCESS
        swapf   FSR0L, W, ACCESS
        andlw   0x0F
        xorwf   FSR0L, F, ACCESS        ; x is complete

        movf    FSR0L, W, ACCESS
        mullw   0x20
        xorwf   PRODL, F, ACCESS        ; low byte of the result
        swapf   FSR0L, W, ACCESS
        andlw   0xF0
        xorwf   PRODH, F, ACCESS
        movlw   1
        movf    PLUSW1, W, ACCESS       ; crc low
        xorwf   PRODH, F, ACCESS        ; high byte of the result
        movf    PRODL, W, ACCESS
        movff   PRODH, PRODL
        return

; ---- a block ----------------------------------------------------------------
; crc low at FSR1+1, high at +2, data low at +3, high at +4, length at +5.
; 20 cycles per byte + 31.
_crc16_block:
        movlw   1
        movff   PLUSW1, crc_low
        movlw   2
        movff   PLUSW1, crc_high
        movlw   3
        movff   PLUSW1, FSR0L
        movlw   4
        movff   PLUSW1, FSR0H
        movlw   5
        movff   PLUSW1, left

next_byte:
        movf    POSTINC0, W, ACCESS
        xorwf   crc_high, W, ACCESS
        movwf   folded, ACCESS
        swapf   folded, W, ACCESS
        andlw   0x0F
        xorwf   folded, F, ACCESS       ; x is complete
        swapf   folded, W, ACCESS
        andlw   0xF0
        xorwf   crc_low, W, ACCESS
        movwf   crc_high, ACCESS
        movf    folded, W, ACCESS
        mullw   0x20
        movf    PRODH, W, ACCESS
        xorwf   crc_high, F, ACCESS
        movf    PRODL, W, ACCESS
        xorwf   folded, W, ACCESS
        movwf   crc_low, ACCESS
        decfsz  left, F, ACCESS
        bra     next_byte

        movff   crc_high, PRODL
        movf    crc_low, W, ACCESS
        return

        end
