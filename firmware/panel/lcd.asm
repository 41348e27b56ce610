; The display: an HD44780 with two lines of 16 characters, four data lines.
; SPDX-License-Identifier: Apache-2.0
;
; lcd.h is the manual. One byte goes out in each call, 2 ms or more after the
; one before: longer than anything the display does, so that nobody waits for
; it. First the power-on sequence of the data sheet (figure 24), a step every
; 32 ms, then our letters, and from then on panel_screen, again and again: what
; interference has spoiled is right again 70 ms later.
;
;   lcd_step   0..3    upper half alone: 3, 3, 3, 2 (four data lines)
;              4..9    two lines; off; clear; to the right; on; address of
;                      our letters
;              10..65  their patterns
;              66..99  panel_screen; a byte with bit 7 is a command there

        include <p18f4550.inc>
        radix   dec

        global  _lcd_poll, _panel_screen
        extern  _settings, text_patterns

PANEL           equ     2 * 34          ; SETTING_PANEL, low byte
INPUTS_A        equ     0x3F            ; TRISA_BOARD
INPUTS_E        equ     0x07
OUTPUTS_A       equ     0x03            ; RA2..RA5 = D4..D7
OUTPUTS_E       equ     0x04
RS              equ     0               ; of port E
E               equ     1
COMMANDS        equ     10
PATTERNS_END    equ     66
SCREEN_SIZE     equ     34

lcd_screen      udata
_panel_screen   res     SCREEN_SIZE
lcd_data        udata
lcd_step        res     1
lcd_wait        res     1
lcd_byte        res     1

lcd_code        code

lcd_commands:
        db      0x30, 0x30, 0x30, 0x20, 0x28, 0x08, 0x01, 0x06, 0x0C, 0x48

_lcd_poll:
        banksel _settings + PANEL
        movf    _settings + PANEL, W, B
        banksel lcd_step
        bnz     fitted
        clrf    lcd_step, B
        movlw   INPUTS_A
        movwf   TRISA, A
        movlw   INPUTS_E
        movwf   TRISE, A
        return

fitted:
        clrf    LATE, A
        movlw   OUTPUTS_A
        movwf   TRISA, A
        movlw   OUTPUTS_E
        movwf   TRISE, A
        movlw   PATTERNS_END
        subwf   lcd_step, W, B
        bc      screen
        movlw   COMMANDS
        subwf   lcd_step, W, B
        bc      pattern
        incf    lcd_wait, F, B
        movlw   15
        andwf   lcd_wait, W, B
        bnz     done
        movf    lcd_step, W, B
        addlw   LOW(lcd_commands)
        movwf   TBLPTRL, A
        movlw   HIGH(lcd_commands)
        bra     table

pattern:                                ; W = its number
        bsf     LATE, RS, A
        addlw   LOW(text_patterns)
        movwf   TBLPTRL, A
        movlw   HIGH(text_patterns)
table:
        movwf   TBLPTRH, A
        movlw   0
        addwfc  TBLPTRH, F, A
        tblrd*
        movff   TABLAT, lcd_byte
        bra     send

screen:                                 ; W = place in panel_screen
        lfsr    0, _panel_screen
        movff   PLUSW0, lcd_byte
        btfss   lcd_byte, 7, B
        bsf     LATE, RS, A
        xorlw   SCREEN_SIZE - 1
        bnz     send
        movlw   PATTERNS_END - 1        ; from the start again
        movwf   lcd_step, B

send:
        incf    lcd_step, F, B
        rcall   nibble
        movlw   5
        subwf   lcd_step, W, B
        bnc     done
        swapf   lcd_byte, F, B
nibble:
        rrncf   lcd_byte, W, B
        rrncf   WREG, W, A
        andlw   0x3C
        movwf   LATA, A
        bsf     LATE, E, A              ; 500 ns
        bra     $ + 2
        bra     $ + 2
        nop
        bcf     LATE, E, A
done:
        return
        end
