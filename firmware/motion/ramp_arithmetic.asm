; Arithmetic of the ramp: division, braking distance, override.
; SPDX-License-Identifier: Apache-2.0
;
; The numbers are those of ramp_tick.asm, in one section and so in one bank.

        include <p18f4550.inc>
        radix   dec

        global  _ramp_set_period, ramp_multiply, _ramp_brake
        extern  wanted, remainder, bits, square, product
        extern  _ramp_speed, _stream_period
        extern  _ramp_scale, _ramp_brake_speed, _ramp_brake_factor
        extern  _ramp_brake_distance

ramp_arithmetic_code code

; Hands the speed to the step interrupt as a period = 12,000,000 * 256 / speed;
; restoring division, about 800 cycles, in 32 bits: the fourth byte is that of
; _ramp_stretch, which has been used by then. A speed of 0 gives the longest.
_ramp_set_period:
        banksel wanted
        clrf    _stream_period, B       ; 3,072,000,000 = B71B0000h
        clrf    _stream_period + 1, B
        movlw   0x1B
        movwf   _stream_period + 2, B
        movlw   0xB7
        movwf   _stream_period + 3, B
        clrf    remainder, B
        clrf    remainder + 1, B
        clrf    remainder + 2, B
        clrf    remainder + 3, B
        movlw   32
        movwf   bits, B
divide_bit:
        bcf     STATUS, C, A
        rlcf    _stream_period, F, B
        rlcf    _stream_period + 1, F, B
        rlcf    _stream_period + 2, F, B
        rlcf    _stream_period + 3, F, B
        rlcf    remainder, F, B
        rlcf    remainder + 1, F, B
        rlcf    remainder + 2, F, B
        rlcf    remainder + 3, F, B
        movf    _ramp_speed, W, B
        subwf   remainder, F, B
        movf    _ramp_speed + 1, W, B
        subwfb  remainder + 1, F, B
        movf    _ramp_speed + 2, W, B
        subwfb  remainder + 2, F, B
        movlw   0
        subwfb  remainder + 3, F, B
        bnc     divide_restore
        bsf     _stream_period, 0, B
        bra     divide_next
divide_restore:
        movf    _ramp_speed, W, B
        addwf   remainder, F, B
        movf    _ramp_speed + 1, W, B
        addwfc  remainder + 1, F, B
        movf    _ramp_speed + 2, W, B
        addwfc  remainder + 2, F, B
        movlw   0
        addwfc  remainder + 3, F, B
divide_next:
        decfsz  bits, F, B
        bra     divide_bit
        return

; Adds PROD to a number from its byte on, carry into the next two bytes.
add_product macro number, byte
        movf    PRODL, W, A
        addwf   number + byte, F, B
        movf    PRODH, W, A
        addwfc  number + byte + 1, F, B
        movlw   0
        addwfc  number + byte + 2, F, B
        endm

; distance = speed^2 / 2a in 1/2 step = (speed^2 / 256) * factor / 65,536;
; about 90 cycles.
_ramp_brake:
        banksel wanted
        clrf    square + 2, B
        clrf    square + 3, B
        movf    _ramp_brake_speed, W, B
        mulwf   _ramp_brake_speed, B
        movff   PRODL, square
        movff   PRODH, square + 1
        movf    _ramp_brake_speed + 1, W, B
        mulwf   _ramp_brake_speed + 1, B
        movff   PRODL, square + 2
        movff   PRODH, square + 3
        movf    _ramp_brake_speed, W, B
        mulwf   _ramp_brake_speed + 1, B
        bcf     STATUS, C, A
        rlcf    PRODL, F, A
        rlcf    PRODH, F, A
        movlw   0
        btfsc   STATUS, C, A
        addlw   1
        addwf   square + 3, F, B
        movf    PRODL, W, A
        addwf   square + 1, F, B
        movf    PRODH, W, A
        addwfc  square + 2, F, B
        movlw   0
        addwfc  square + 3, F, B

        clrf    product + 2, B
        clrf    product + 3, B
        clrf    product + 4, B
        movf    square + 1, W, B
        mulwf   _ramp_brake_factor, B
        movff   PRODL, product
        movff   PRODH, product + 1
        movf    square + 2, W, B
        mulwf   _ramp_brake_factor, B
        add_product product, 1
        movf    square + 3, W, B
        mulwf   _ramp_brake_factor, B
        add_product product, 2
        movf    square + 1, W, B
        mulwf   _ramp_brake_factor + 1, B
        add_product product, 1
        movf    square + 2, W, B
        mulwf   _ramp_brake_factor + 1, B
        add_product product, 2
        movf    square + 3, W, B
        mulwf   _ramp_brake_factor + 1, B
        movf    PRODL, W, A
        addwf   product + 3, F, B
        movf    PRODH, W, A
        addwfc  product + 4, F, B
        movff   product + 2, _ramp_brake_distance
        movff   product + 3, _ramp_brake_distance + 1
        movf    product + 4, W, B
        bz      brake_done
        setf    _ramp_brake_distance, B
        setf    _ramp_brake_distance + 1, B
brake_done:
        return

; wanted = wanted * scale / 256; 24 by 9 bits, about 60 cycles.
ramp_multiply:
        banksel wanted
        clrf    product, B
        clrf    product + 1, B
        clrf    product + 2, B
        clrf    product + 3, B
        clrf    product + 4, B
        movf    wanted, W, B
        mulwf   _ramp_scale, B
        add_product product, 0
        movf    wanted + 1, W, B
        mulwf   _ramp_scale, B
        add_product product, 1
        movf    wanted + 2, W, B
        mulwf   _ramp_scale, B
        add_product product, 2
        btfss   _ramp_scale + 1, 0, B   ; 256..511
        bra     not_once
        movf    wanted, W, B
        addwf   product + 1, F, B
        movf    wanted + 1, W, B
        addwfc  product + 2, F, B
        movf    wanted + 2, W, B
        addwfc  product + 3, F, B
        movlw   0
        addwfc  product + 4, F, B
not_once:
        btfss   _ramp_scale + 1, 1, B   ; 512: 200 %
        bra     not_twice
        bcf     STATUS, C, A
        rlcf    wanted, F, B
        rlcf    wanted + 1, F, B
        rlcf    wanted + 2, F, B
        rlcf    wanted + 3, F, B
        return
not_twice:
        movff   product + 1, wanted
        movff   product + 2, wanted + 1
        movff   product + 3, wanted + 2
        movff   product + 4, wanted + 3
        return
        end
