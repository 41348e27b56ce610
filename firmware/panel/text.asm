; Texts of the panel: reads them out of their Huffman code.
; SPDX-License-Identifier: Apache-2.0
;
; text.h is the manual; text_code.py writes the code. It is canonical: codes of
; the same length follow each other, and longer ones come behind them. So with
; the code less the first one of its length: where it is smaller than the
; number of codes of that length, it is one of them, and else that number is
; taken off and the next bit put behind.

        include <p18f4550.inc>
        radix   dec

        global  _text_show, _text_number, _text_at, _text_room
        global  text_patterns           ; of our letters, for lcd.asm
        extern  _panel_screen, _settings, _factor_1, _factor_2

PANEL           equ     2 * 34          ; SETTING_PANEL, low byte
SPANISH         equ     1               ; its bit
CAPITAL         equ     0x20            ; difference to a small letter

text_data       udata
_text_number    res     1
_text_at        res     1
_text_room      res     1

; For a while, the numbers of arithmetic.asm: the main loop's too.
#define skip    _factor_1                ; texts before the one wanted
#define bits        _factor_1 + 1   ; to come, a 1 behind the last
#define source      _factor_1 + 2   ; next byte of them, 2 bytes
#define rest        _factor_2       ; code less the first of its length
#define index       _factor_2 + 1   ; letters with shorter codes

text_code       code

        include "texts.inc"

point macro table                       ; TBLPTR = table + W
        addlw   LOW(table)
        movwf   TBLPTRL, A
        movlw   HIGH(table)
        movwf   TBLPTRH, A
        movlw   0
        addwfc  TBLPTRH, F, A
        endm

_text_show:
        banksel _settings + PANEL
        movlw   0
        btfsc   _settings + PANEL, SPANISH, B
        movlw   TEXT_COUNT
        banksel _text_number
        addwf   _text_number, W, B
        movwf   skip, A
        rrncf   WREG, W, A              ; two bytes for eight texts
        rrncf   WREG, W, A
        andlw   0x3E
        point   text_groups
        tblrd*+
        movff   TABLAT, source
        tblrd*+
        movff   TABLAT, source + 1
        movlw   7
        andwf   skip, F, A
        clrf    bits, A
        bsf     bits, 7, A              ; none left
        bra     skipped
skip_letter:
        rcall   letter
        bnz     skip_letter
        decf    skip, F, A
skipped:
        tstfsz  skip, A
        bra     skip_letter
        lfsr    0, _panel_screen
        movf    _text_at, W, B
        addwf   FSR0L, F, A             ; panel_screen lies in one page
        rcall   letter
        btfsc   WREG, 6, A
        andlw   ~CAPITAL
next_letter:
        bz      pad
        movwf   POSTINC0, A
        decf    _text_room, F, B
        bz      shown
        rcall   letter
        bra     next_letter
pad:
        movlw   ' '
        movwf   POSTINC0, A
        decfsz  _text_room, F, B
        bra     pad
shown:
        return

; W = next letter, Z set at the end of a text.
letter:
        clrf    rest, A
        clrf    index, A
        movlw   0
        point   text_counts
longer:
        bcf     STATUS, C, A
        rlcf    bits, F, A
        bnz     bit_read
        movff   TBLPTRL, PRODL
        movff   TBLPTRH, PRODH
        movff   source, TBLPTRL
        movff   source + 1, TBLPTRH
        tblrd*+
        movff   TABLAT, bits
        movff   TBLPTRL, source
        movff   TBLPTRH, source + 1
        movff   PRODL, TBLPTRL
        movff   PRODH, TBLPTRH
        bsf     STATUS, C, A
        rlcf    bits, F, A
bit_read:
        rlcf    rest, F, A
        tblrd*+
        movf    TABLAT, W, A
        subwf   rest, W, A
        bnc     found
        movwf   rest, A
        movf    TABLAT, W, A
        addwf   index, F, A
        bra     longer
found:
        movf    rest, W, A
        addwf   index, W, A
        point   text_letters
        tblrd*
        movf    TABLAT, W, A
        return
        end
