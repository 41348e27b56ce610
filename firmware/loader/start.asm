; Boot loader: vectors, what to start, main loop.
; SPDX-License-Identifier: Apache-2.0
;
; After every reset the loader sees whether the program is whole and starts
; it, 61 ms after the reset. It stays when the program is not whole, when the
; program asks for it (key in RAM and a RESET instruction), or when HOLD is
; down while power comes. RCON and STKPTR are left as they are for the program
; to read.
;
; Windings and relays are driven off before anything else: the pull-ups that
; keep open buttons up would switch windings on. No interrupt is ever enabled.

        include "loader.inc"

        global  loader_restart, loader_check, loader_delay, crc_add
        extern  bus_reset, transaction, answer_request

loader_reset    code    0x000000
        goto    loader_start
loader_high     code    0x000008
        goto    PROGRAM_HIGH_INTERRUPT
loader_low      code    0x000018
        goto    PROGRAM_LOW_INTERRUPT

loader_code     code
loader_start:
        clrf    LATB, A                 ; after power-on latches hold anything
        clrf    LATC, A
        clrf    LATD, A
        movlw   COILS_OUT
        movwf   TRISB, A
        movwf   TRISD, A
        movlw   LED_AND_RELAYS_OUT
        movwf   TRISC, A
        bsf     PORTE, RDPU, A          ; pull-ups: a button left open is up
        bcf     INTCON2, RBPU, A
        rcall   loader_check
        btfsc   RCON, RI, A             ; 0 = a RESET instruction
        bra     not_asked
        movlw   'T'
        xorwf   key_low, W, A
        bnz     not_asked
        movlw   'L'
        xorwf   key_high, W, A
        bz      loader_stay
not_asked:
        btfss   whole, 0, A
        bra     loader_stay
        btfsc   RCON, POR, A            ; 0 = power has come
        goto    PROGRAM_ENTRY
        btfsc   HOLD_BUTTON
        goto    PROGRAM_ENTRY

loader_stay:
        clrf    key_low, A
        clrf    notes, A
        movlw   0x85                    ; on, 16 bits, 12 MHz / 64
        movwf   T0CON, A
        movlb   4

; The LED flashes twice, three times a second.
loader_turn:
        clrwdt
        movf    TMR0L, W, A             ; latches TMR0H
        movlw   LED_MASK
        btfsc   TMR0H, 7, A
        clrf    WREG, A
        btfss   TMR0H, 5, A
        clrf    WREG, A
        movwf   LATC, A

        btfsc   VBUS_SENSE
        bra     supplied
        clrf    UCON, A
        bra     loader_turn
supplied:
        btfsc   UCON, USBEN, A
        bra     attached
        rcall   loader_delay            ; plugs bounce
        btfss   VBUS_SENSE
        bra     loader_turn
        call    bus_reset
        movlw   0x14                    ; pull-up, full speed
        movwf   UCFG, A
        clrf    UIR, A
        clrf    UEIE, A
        clrf    UIE, A
        movlw   1 << USBEN
        movwf   UCON, A
attached:
        btfss   UIR, URSTIF, A
        bra     no_reset
        call    bus_reset
        bcf     UIR, URSTIF, A
no_reset:
        btfss   UIR, STALLIF, A
        bra     no_stall
        bcf     UIR, STALLIF, A         ; first: another stall raises it again
        bcf     UEP0, EPSTALL, A
no_stall:
        btfsc   UIR, TRNIF, A
        call    transaction
        tstfsz  asked, A
        call    answer_request
        bra     loader_turn

; The answer to GO has gone: off the bus long enough for the host to see it.
loader_restart:
        clrf    UCON, A
        rcall   loader_delay
        reset

; 50 ms.
loader_delay:
        movlw   65                      ; 65 * 256 * 36 cycles
        movwf   delay_high, A
        clrf    delay_low, A
delay_turn:
        clrwdt
        movlw   10
delay_more:
        addlw   -1
        bnz     delay_more
        decfsz  delay_low, F, A
        bra     delay_turn
        decfsz  delay_high, F, A
        bra     delay_turn
        return

; Is the program whole? Sets or clears `whole`. Reads the program from the
; field behind its CRC to its end; 27 cycles a byte, 60 ms in all. The watchdog
; is left alone, which takes 256 ms: CLRWDT would forget that it has bitten.
loader_check:
        clrf    whole, A
        clrf    TBLPTRU, A
        movlw   HIGH PROGRAM_SEALED
        movwf   TBLPTRH, A
        movlw   LOW PROGRAM_SEALED
        movwf   TBLPTRL, A
        tblrd*+
        movff   TABLAT, seal_end_low
        tblrd*-
        movff   TABLAT, seal_end_high
        btfsc   seal_end_high, 7, A
        return                          ; erased, or no program of ours
        movlw   (HIGH PROGRAM_BEGIN) + 1
        cpfslt  seal_end_high, A
        bra     check_begin
        return
check_begin:
        setf    crc_sum_low, A
        setf    crc_sum_high, A
check_turn:
        tblrd*+
        movf    TABLAT, W, A
        rcall   crc_add
        movf    TBLPTRL, W, A
        xorwf   seal_end_low, W, A
        bnz     check_turn
        movf    TBLPTRH, W, A
        xorwf   seal_end_high, W, A
        bnz     check_turn
        movlw   HIGH PROGRAM_CRC
        movwf   TBLPTRH, A
        clrf    TBLPTRL, A
        tblrd*+
        movf    TABLAT, W, A
        xorwf   crc_sum_low, W, A
        bnz     check_done
        tblrd*+
        movf    TABLAT, W, A
        xorwf   crc_sum_high, W, A
        bnz     check_done
        incf    whole, F, A
check_done:
        return

; One more byte, W, for the CRC-16/CCITT-FALSE: the formula of link/crc.asm.
crc_add:
        xorwf   crc_sum_high, W, A
        movwf   crc_fold, A
        swapf   crc_fold, W, A
        andlw   0x0F
        xorwf   crc_fold, F, A
        movf    crc_fold, W, A
        mullw   0x20
        xorwf   PRODL, W, A
        movff   crc_sum_low, crc_sum_high
        movwf   crc_sum_low, A
        swapf   crc_fold, W, A
        andlw   0xF0
        xorwf   PRODH, W, A
        xorwf   crc_sum_high, F, A
        return
        end
