; The keys: eight on one analogue input, see ladder.h.
; SPDX-License-Identifier: Apache-2.0

        include <p18f4550.inc>
        radix   dec

        global  _ladder_read

ONE_ANALOGUE    equ     0x0E            ; ADCON1: AN0 only
SLOW_LEFT       equ     0x3E            ; ADCON2: left, 20 TAD, Fosc/64
CHANNEL_0       equ     0x01            ; ADCON0: on
HALF            equ     16              ; half the distance of two keys

ladder_code     code

_ladder_read:
        movlw   ONE_ANALOGUE
        movwf   ADCON1, A
        movlw   SLOW_LEFT
        movwf   ADCON2, A
        movlw   CHANNEL_0
        movwf   ADCON0, A
        movf    ADRESH, W, A            ; of the conversion before
        bsf     ADCON0, GO, A           ; 42 us
        addlw   HALF
        bc      none
        swapf   WREG, W, A
        rrncf   WREG, W, A
        andlw   7
        return
none:
        movlw   8
        return
        end
