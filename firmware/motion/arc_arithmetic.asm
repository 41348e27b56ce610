; 32-bit arithmetic of an arc: see arc.c, which calls these.
; SPDX-License-Identifier: Apache-2.0
;
; One accumulator, and routines that combine it with the number FSR0 points
; to: an operation costs 6 bytes where compiled C needs 30.

        include <p18f4550.inc>
        radix   dec

        global  _arc_p, _arc_m, _arc_goal_p, _arc_goal_m, _arc_error
        global  _arc_dx, _arc_dz, _arc_growing, _arc_entries
        global  _arc_rest_p, _arc_rest_m, _arc_steps_p
        global  _arc_sine_step, _arc_root, _arc_signs, _arc_shift
        global  _arc_scaled_p, _arc_border, _arc_missed
        global  _root_of, _arc_enter, _arc_measure, _arc_exchange, _arc_mirror_p
        global  _arc_mirror_m, _arc_set_up, _arc_finish, do_load, do_store
        global  do_add, absolute, half, accumulator, value, bit_mask, kept
        extern  scale
        extern  _run_change_major, _run_change_minor, _run_decision
        extern  _run_curve, _run_sine, _run_sine_step

OFFSET          equ     384 - 48        ; 3/2 less INNER, see arc.c

arc_data        udata
_arc_p          res 4
_arc_m          res 4
_arc_goal_p     res 4
_arc_goal_m     res 4
_arc_error      res 4
_arc_dx         res 2
_arc_dz         res 2
_arc_growing    res 1
_arc_entries    res 2
_arc_rest_p     res 2                   ; steps to the goal, rounded
_arc_rest_m     res 2
_arc_steps_p    res 2                   ; |p| in steps, rounded
_arc_sine_step  res 4
_arc_root       res 2                   ; R / sqrt(2), scaled
_arc_shift      res 1                   ; scaled = number >> shift, 16 bits
_arc_scaled_p   res 2                   ; |p|
_arc_border     res 2                   ; steps from p to R / sqrt(2)
_arc_signs      res 1                   ; P_NEGATIVE and so on of arc.c
_arc_missed     res 4
factor          res 4
_root_of
value           res 4
kept            res 2
accumulator     res 4
bit_mask        res 2
arc_code        code
; --- accumulator -------------------------------------------------------------
load            macro   number
        lfsr    0, number
        rcall   do_load
        endm
store           macro   number
        lfsr    0, number
        rcall   do_store
        endm
add             macro   number
        lfsr    0, number
        rcall   do_add
        endm
subtract        macro   number
        lfsr    0, number
        rcall   do_subtract
        endm

do_load:
        banksel accumulator
        movff   POSTINC0, accumulator
        movff   POSTINC0, accumulator + 1
        movff   POSTINC0, accumulator + 2
        movff   POSTINC0, accumulator + 3
        return
do_store:
        movff   accumulator, POSTINC0
        movff   accumulator + 1, POSTINC0
        movff   accumulator + 2, POSTINC0
        movff   accumulator + 3, POSTINC0
        return
do_add:
        movf    POSTINC0, W, A
        addwf   accumulator, F, B
        movf    POSTINC0, W, A
        addwfc  accumulator + 1, F, B
        movf    POSTINC0, W, A
        addwfc  accumulator + 2, F, B
        movf    POSTINC0, W, A
        addwfc  accumulator + 3, F, B
        return
do_subtract:
        movf    POSTINC0, W, A
        subwf   accumulator, F, B
        movf    POSTINC0, W, A
        subwfb  accumulator + 1, F, B
        movf    POSTINC0, W, A
        subwfb  accumulator + 2, F, B
        movf    POSTINC0, W, A
        subwfb  accumulator + 3, F, B
        return
negate:
        comf    accumulator + 3, F, B
        comf    accumulator + 2, F, B
        comf    accumulator + 1, F, B
        negf    accumulator, B
        movlw   0
        btfss   STATUS, Z, A
        return
        bsf     STATUS, C, A
        addwfc  accumulator + 1, F, B
        addwfc  accumulator + 2, F, B
        addwfc  accumulator + 3, F, B
        return
absolute:
        btfsc   accumulator + 3, 7, B
        bra     negate
        return
twice:
        bcf     STATUS, C, A
        rlcf    accumulator, F, B
        rlcf    accumulator + 1, F, B
        rlcf    accumulator + 2, F, B
        rlcf    accumulator + 3, F, B
        return
; Arithmetic shift right by one.
half:
        bcf     STATUS, C, A
        btfsc   accumulator + 3, 7, B
        bsf     STATUS, C, A
        rrcf    accumulator + 3, F, B
        rrcf    accumulator + 2, F, B
        rrcf    accumulator + 1, F, B
        rrcf    accumulator, F, B
        return
; Adds the signed number of steps FSR0 points to.
add_steps:
        movf    POSTINC0, W, A
        addwf   accumulator + 1, F, B
        movf    INDF0, W, A
        addwfc  accumulator + 2, F, B
        movlw   0
        btfsc   INDF0, 7, A
        movlw   0xFF
        addwfc  accumulator + 3, F, B
        return
; Adds W, 0..255, and PRODH in the second byte.
add_small:
        addwf   accumulator, F, B
        movf    PRODH, W, A
        addwfc  accumulator + 1, F, B
        movlw   0
        addwfc  accumulator + 2, F, B
        addwfc  accumulator + 3, F, B
        return

; --- frame -------------------------------------------------------------------
; p, m hold the centre from the start; turns them into the start from the
; centre, and finds the goal.
_arc_enter:
        load    _arc_p
        rcall   negate
        store   _arc_p
        lfsr    0, _arc_dx
        rcall   add_steps
        store   _arc_goal_p
        load    _arc_m
        rcall   negate
        store   _arc_m
        lfsr    0, _arc_dz
        rcall   add_steps
        store   _arc_goal_m
        ; How far the circle's square is off at the end.
        add     _arc_m                  ; m + goal m
        store   factor
        clrf    accumulator, B
        clrf    accumulator + 1, B
        clrf    accumulator + 2, B
        clrf    accumulator + 3, B
        store   _arc_error
        movff   _arc_dz, bit_mask
        movff   _arc_dz + 1, bit_mask + 1
        rcall   add_product
        store   value
        load    _arc_p
        add     _arc_goal_p
        store   factor
        load    value
        movff   _arc_dx, bit_mask
        movff   _arc_dx + 1, bit_mask + 1
        rcall   add_product
        rcall   absolute
        rcall   half
        bra     store_missed

; accumulator += factor * bit_mask, modulo 2^32, signed. Both are used up.
add_product:
        movlw   16
        movwf   PRODH, A
        movff   bit_mask + 1, PRODL     ; its sign
product_bit:
        bcf     STATUS, C, A
        rrcf    bit_mask + 1, F, B
        rrcf    bit_mask, F, B
        bnc     product_next
        lfsr    0, factor
        rcall   do_add
product_next:
        bcf     STATUS, C, A
        rlcf    factor, F, B
        rlcf    factor + 1, F, B
        rlcf    factor + 2, F, B
        rlcf    factor + 3, F, B
        decfsz  PRODH, F, A
        bra     product_bit
        btfss   PRODL, 7, A
        return
        lfsr    0, factor
        bra     do_subtract
store_missed:
        store   _arc_missed
        return
_arc_exchange:
        lfsr    0, _arc_p
        rcall   exchange_next
        lfsr    0, _arc_goal_p
exchange_next:
        movlw   4
exchange_byte:
        movff   INDF0, PRODL
        movff   WREG, PRODH
        movlw   4
        movff   PLUSW0, value
        movff   value, INDF0
        movff   PRODL, PLUSW0
        movf    POSTINC0, W, A
        movf    PRODH, W, A
        decfsz  WREG, F, A
        bra     exchange_byte
        return

_arc_mirror_p:
        lfsr    0, _arc_p
        rcall   mirror
        lfsr    0, _arc_goal_p
        bra     mirror
_arc_mirror_m:
        lfsr    0, _arc_m
        rcall   mirror
        lfsr    0, _arc_goal_m
mirror:
        rcall   do_load
        rcall   negate
        movlw   -4
        addwf   FSR0L, F, A
        movlw   0xFF
        addwfc  FSR0H, F, A
        bra     do_store

; Steps in the accumulator, rounded, to where FSR0 points.
put_rounded:
        movff   FSR0L, value
        movff   FSR0H, value + 1
        clrf    PRODH, A
        movlw   128
        rcall   add_small
        movff   value, FSR0L
        movff   value + 1, FSR0H
        movff   accumulator + 1, POSTINC0
        movff   accumulator + 2, POSTINC0
        return

_arc_measure:
        load    _arc_goal_p
        subtract _arc_p
        lfsr    0, _arc_rest_p
        rcall   put_rounded
        load    _arc_goal_m
        clrf    _arc_signs, B
        btfss   accumulator + 3, 7, B
        bsf     _arc_signs, 4, B
        subtract _arc_m
        lfsr    0, _arc_rest_m
        rcall   put_rounded
        load    _arc_m
        btfsc   accumulator + 3, 7, B
        bsf     _arc_signs, 1, B
        rcall   absolute
        store   value
        load    _arc_p
        btfsc   accumulator + 3, 7, B
        bsf     _arc_signs, 0, B
        rcall   absolute
        subtract value
        movf    accumulator, W, B
        iorwf   accumulator + 1, W, B
        iorwf   accumulator + 2, W, B
        iorwf   accumulator + 3, W, B
        bz      sizes_equal
        btfss   accumulator + 3, 7, B
        bsf     _arc_signs, 2, B
        bra     measure_border
sizes_equal:
        bsf     _arc_signs, 3, B
measure_border:
        load    _arc_p
        rcall   absolute
        call    scale
        movff   accumulator, _arc_scaled_p
        movff   accumulator + 1, _arc_scaled_p + 1
        load    _arc_p
        rcall   absolute
        lfsr    0, _arc_steps_p
        rcall   put_rounded
        movff   _arc_root, accumulator
        movff   _arc_root + 1, accumulator + 1
        clrf    accumulator + 2, B
        clrf    accumulator + 3, B
        movf    _arc_shift, W, B
        bz      border_found
border_shift:
        movwf   bit_mask, B
        rcall   twice
        decfsz  bit_mask, W, B
        bra     border_shift
border_found:
        subtract _arc_p
        lfsr    0, _arc_border
        bra     put_rounded

; --- decision ----------------------------------------------------------------
_arc_set_up:
        load    _arc_m
        rcall   twice
        rcall   negate
        store   _run_change_minor
        load    _arc_p
        rcall   twice
        store   value
        movlw   1
        movwf   PRODH, A
        movlw   0
        rcall   add_small
        btfss   _arc_growing, 0, B
        rcall   negate
        store   _run_change_major
        load    _arc_error
        add     value
        movlw   HIGH(OFFSET)
        movwf   PRODH, A
        movlw   LOW(OFFSET)
        rcall   add_small
        btfss   _arc_growing, 0, B
        rcall   negate
        subtract _arc_m
        store   _run_decision
        load    _arc_sine_step
        btfss   _arc_growing, 0, B
        rcall   negate
        store   _run_sine_step
        rcall   half
        rcall   negate
        add     _run_sine
        store   _run_sine
        banksel _arc_growing
        movlw   2
        btfss   _arc_growing, 0, B
        movlw   -2
        movff   WREG, _run_curve
        movlw   0
        btfss   _arc_growing, 0, B
        movlw   0xFF
        movff   WREG, _run_curve + 1
        return

_arc_finish:
        load    _run_change_minor
        rcall   half
        rcall   negate
        store   _arc_m
        load    _arc_p
        lfsr    0, _arc_entries
        rcall   add_steps
        store   _arc_p
        rcall   twice
        movlw   HIGH(OFFSET)
        movwf   PRODH, A
        movlw   LOW(OFFSET)
        rcall   add_small
        store   value
        load    _run_decision
        add     _arc_m
        btfss   _arc_growing, 0, B
        rcall   negate
        subtract value
        store   _arc_error
        return

        end
