; Multiplication and division for compiled C, in place of the compiler's own.
; SPDX-License-Identifier: Apache-2.0
;
; SDCC calls these names for the operators * / % on 16 and 32 bits without
; sign. Its library needs 1,390 bytes for them, these 420, and half the
; cycles: 45 for a product of 16 bits, 180 for one of 32, 330 and 970 for a
; quotient of 16 and 32.
; Division by 0 gives a quotient of ones.
;
; Arguments lie on the software stack, FSR1 below the first byte; results
; come in WREG, PRODL, PRODH, FSR0L, low byte first. Not for interrupts: the
; work is in fixed places.

        include <p18f4550.inc>
        radix   dec

        global  __mulint, __mullong, __divuint, __moduint, __divulong
        global  _factor_1, _factor_2, _divisor, _product, _proportion
        global  _proportion_digit

arithmetic_data udata_acs
_factor_1
first           res 4                   ; dividend, then quotient
_factor_2
second          res 4
_divisor        res 2
remainder       res 4
bits            res 1

code_arithmetic code

; Copies so many bytes of each argument from the stack.
arguments macro bytes
        local   byte = 0
        movff   FSR1L, FSR0L
        movff   FSR1H, FSR0H
        while   byte < bytes
        movff   PREINC0, first + byte
byte += 1
        endw
byte = 0
        while   byte < bytes
        movff   PREINC0, second + byte
byte += 1
        endw
        endm

__mulint:
        arguments 2
        movf    first, W, A
        mulwf   second, A
        movff   PRODL, remainder
        movff   PRODH, remainder + 1
        mulwf   second + 1, A
        movf    PRODL, W, A
        addwf   remainder + 1, F, A
        movf    first + 1, W, A
        mulwf   second, A
        movf    PRODL, W, A
        addwf   remainder + 1, F, A
result_remainder:
        movff   remainder + 1, PRODL
        movf    remainder, W, A
        return

; 32 bits of factor_1 times factor_2, see arithmetic.h.
_product:
        clrf    first + 2, A
        clrf    first + 3, A
        clrf    second + 2, A
        clrf    second + 3, A
        bra     multiply
; The same, divided by divisor.
_proportion:
        rcall   _product
        movff   remainder, first
        movff   remainder + 1, first + 1
        movff   remainder + 2, first + 2
        movff   remainder + 3, first + 3
        movff   _divisor, second
        movff   _divisor + 1, second + 1
        bra     divide
; Last decimal digit of its 32 bits, which are divided by ten.
_proportion_digit:
        movlw   10
        movwf   second, A
        clrf    second + 1, A
        clrf    second + 2, A
        clrf    second + 3, A
        rcall   divide
        movf    remainder, W, A
        return

__mullong:
        arguments 4
multiply:
        clrf    remainder + 2, A
        clrf    remainder + 3, A
        movf    first, W, A
        mulwf   second, A
        movff   PRODL, remainder
        movff   PRODH, remainder + 1
        mulwf   second + 1, A
        rcall   add_1
        mulwf   second + 2, A
        rcall   add_2
        mulwf   second + 3, A
        rcall   add_3
        movf    first + 1, W, A
        mulwf   second, A
        rcall   add_1
        movf    first + 1, W, A
        mulwf   second + 1, A
        rcall   add_2
        movf    first + 1, W, A
        mulwf   second + 2, A
        rcall   add_3
        movf    first + 2, W, A
        mulwf   second, A
        rcall   add_2
        movf    first + 2, W, A
        mulwf   second + 1, A
        rcall   add_3
        movf    first + 3, W, A
        mulwf   second, A
        rcall   add_3
        movff   remainder + 1, PRODL
        movff   remainder + 2, PRODH
        movff   remainder + 3, FSR0L
        movf    remainder, W, A
        return

; Add PROD to the product from its byte 1, 2 or 3 on; W := first.
add_1:
        movf    PRODL, W, A
        addwf   remainder + 1, F, A
        movf    PRODH, W, A
        addwfc  remainder + 2, F, A
        movlw   0
        addwfc  remainder + 3, F, A
        movf    first, W, A
        return
add_2:
        movf    PRODL, W, A
        addwf   remainder + 2, F, A
        movf    PRODH, W, A
        addwfc  remainder + 3, F, A
        movf    first, W, A
        return
add_3:
        movf    PRODL, W, A
        addwf   remainder + 3, F, A
        return

__divuint:
        rcall   divide_16
        movff   first + 1, PRODL
        movf    first, W, A
        return

__moduint:
        rcall   divide_16
        bra     result_remainder

divide_16:
        arguments 2
        clrf    remainder, A
        clrf    remainder + 1, A
        movlw   16
        movwf   bits, A
next_16:
        bcf     STATUS, C, A
        rlcf    first, F, A
        rlcf    first + 1, F, A
        rlcf    remainder, F, A
        rlcf    remainder + 1, F, A
        bc      fits_16                 ; 17 bits: larger than any divisor
        movf    second, W, A
        subwf   remainder, W, A
        movf    second + 1, W, A
        subwfb  remainder + 1, W, A
        bnc     less_16
fits_16:
        movf    second, W, A
        subwf   remainder, F, A
        movf    second + 1, W, A
        subwfb  remainder + 1, F, A
        bsf     first, 0, A
less_16:
        decfsz  bits, F, A
        bra     next_16
        return

__divulong:
        arguments 4
divide:
        clrf    remainder, A
        clrf    remainder + 1, A
        clrf    remainder + 2, A
        clrf    remainder + 3, A
        movlw   32
        movwf   bits, A
next_32:
        bcf     STATUS, C, A
        rlcf    first, F, A
        rlcf    first + 1, F, A
        rlcf    first + 2, F, A
        rlcf    first + 3, F, A
        rlcf    remainder, F, A
        rlcf    remainder + 1, F, A
        rlcf    remainder + 2, F, A
        rlcf    remainder + 3, F, A
        bc      fits_32
        movf    second, W, A
        subwf   remainder, W, A
        movf    second + 1, W, A
        subwfb  remainder + 1, W, A
        movf    second + 2, W, A
        subwfb  remainder + 2, W, A
        movf    second + 3, W, A
        subwfb  remainder + 3, W, A
        bnc     less_32
fits_32:
        movf    second, W, A
        subwf   remainder, F, A
        movf    second + 1, W, A
        subwfb  remainder + 1, F, A
        movf    second + 2, W, A
        subwfb  remainder + 2, F, A
        movf    second + 3, W, A
        subwfb  remainder + 3, F, A
        bsf     first, 0, A
less_32:
        decfsz  bits, F, A
        bra     next_32
        movff   first + 1, PRODL
        movff   first + 2, PRODH
        movff   first + 3, FSR0L
        movf    first, W, A
        return
        end
