; Radius of an arc: see arc.c, which calls this, and arc_arithmetic.asm.
; SPDX-License-Identifier: Apache-2.0

        include <p18f4550.inc>
        radix   dec

        global  _arc_find_root, _root_find, scale
        extern  do_load, do_store, do_add, absolute, half
        extern  accumulator, value, bit_mask, kept
        extern  _arc_p, _arc_m, _arc_root, _arc_shift, _arc_missed

arc_root_code   code

; Shifts the accumulator right by the scale.
scale:
        movf    _arc_shift, W, B
        btfsc   STATUS, Z, A
        return
scale_bit:
        movwf   bit_mask, B
        call    half
        decfsz  bit_mask, W, B
        bra     scale_bit
        return

; --- root --------------------------------------------------------------------
; shift: so that |p| and |m| fit 16 bits; then root = sqrt((p^2 + m^2) / 2),
; which is R / sqrt(2).
_arc_find_root:
        banksel accumulator
        clrf    _arc_shift, B
find_shift:
        lfsr    0, _arc_m                  ; the larger one, positive
        call    do_load
        rcall   scale
        movf    accumulator + 2, W, B
        iorwf   accumulator + 3, W, B
        bz      shift_found
        incf    _arc_shift, F, B
        bra     find_shift
shift_found:
        rcall   half_square
        lfsr    0, value
        call    do_store
        lfsr    0, _arc_p
        call    do_load
        call    absolute
        rcall   scale
        rcall   half_square
        lfsr    0, value
        call    do_add
        lfsr    0, value
        call    do_store
        rcall   find_root
        lfsr    0, _arc_missed
        call    do_load
        rcall   scale
        lfsr    0, _arc_missed
        call    do_store
        return

; root = square root of the value, rounded down.
find_root:
        clrf    _arc_root, B
        clrf    _arc_root + 1, B
        clrf    bit_mask, B
        movlw   0x80
        movwf   bit_mask + 1, B
root_bit:
        movf    bit_mask, W, B
        xorwf   _arc_root, F, B
        movf    bit_mask + 1, W, B
        xorwf   _arc_root + 1, F, B
        rcall   square
        lfsr    0, value
        movf    accumulator, W, B       ; value - square: no carry = less
        subwf   POSTINC0, W, A
        movf    accumulator + 1, W, B
        subwfb  POSTINC0, W, A
        movf    accumulator + 2, W, B
        subwfb  POSTINC0, W, A
        movf    accumulator + 3, W, B
        subwfb  POSTINC0, W, A
        bc      root_keep
        movf    bit_mask, W, B
        xorwf   _arc_root, F, B
        movf    bit_mask + 1, W, B
        xorwf   _arc_root + 1, F, B
root_keep:
        bcf     STATUS, C, A
        rrcf    bit_mask + 1, F, B
        rrcf    bit_mask, F, B
        bnc     root_bit
        return

; uint16_t root_find(void): the root of _root_of. Leaves the arc as it is.
_root_find:
        banksel accumulator
        movff   _arc_root, kept
        movff   _arc_root + 1, kept + 1
        rcall   find_root
        movff   _arc_root + 1, PRODL
        movf    _arc_root, W, B
        movff   kept, _arc_root
        movff   kept + 1, _arc_root + 1
        return

; accumulator = accumulator^2 / 2
half_square:
        movff   accumulator, _arc_root
        movff   accumulator + 1, _arc_root + 1
        rcall   square
        bcf     STATUS, C, A
        rrcf    accumulator + 3, F, B
        rrcf    accumulator + 2, F, B
        rrcf    accumulator + 1, F, B
        rrcf    accumulator, F, B
        return

; accumulator = root^2
square:
        movf    _arc_root, W, B
        mulwf   _arc_root, B
        movff   PRODL, accumulator
        movff   PRODH, accumulator + 1
        movf    _arc_root + 1, W, B
        mulwf   _arc_root + 1, B
        movff   PRODL, accumulator + 2
        movff   PRODH, accumulator + 3
        movf    _arc_root, W, B
        mulwf   _arc_root + 1, B
        rcall   add_cross
add_cross:
        movf    PRODL, W, A
        addwf   accumulator + 1, F, B
        movf    PRODH, W, A
        addwfc  accumulator + 2, F, B
        movlw   0
        addwfc  accumulator + 3, F, B
        return
        end
