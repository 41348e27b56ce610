; Boot loader: the requests of the host (README.md), and writing flash.
; SPDX-License-Identifier: Apache-2.0
;
; A request is one packet, so is its answer; the next is taken when the answer
; has gone. Flash is compared after every write.

        include "loader.inc"

        global  answer_request
        extern  bulk_answer, bulk_listen, loader_check, crc_add

; Results; 0 = done
DAMAGED         equ     1               ; length or CRC of the request
UNKNOWN         equ     2
WRONG_PLACE     equ     3
NOT_KEPT        equ     4               ; flash holds something else
NOT_WHOLE       equ     5

ROW             equ     32              ; bytes written at once
SHORTEST        equ     5               ; command, address, CRC
ERASED          equ     0xFF
; EECON1
ERASE_BLOCK     equ     0x94            ; EEPGD, FREE, WREN
WRITE_ROW       equ     0x84            ; EEPGD, WREN

#define COMMAND         LOW REQUEST_PACKET
#define PLACE_LOW       LOW REQUEST_PACKET + 1
#define PLACE_HIGH      LOW REQUEST_PACKET + 2

loader_requests   code
answer_request:
        btfsc   LOW EP2_IN, 7, B        ; the last answer has not gone yet
        return
        clrf    answer_result, A
        lfsr    2, ANSWER_PACKET + 2
        rcall   request_whole
        bnz     damaged
        movf    COMMAND, W, B
        xorlw   'I'
        bz      identify
        xorlw   'W' ^ 'I'
        bz      write
        xorlw   'R' ^ 'W'
        bz      read
        xorlw   'G' ^ 'R'
        bz      go
        movlw   UNKNOWN
        bra     refused
damaged:
        movlw   DAMAGED
refused:
        movwf   answer_result, A
; The answer is written from FSR2 backwards to its start; its CRC comes last.
answer:
        movff   REQUEST_PACKET, ANSWER_PACKET
        movff   answer_result, ANSWER_PACKET + 1
        movf    FSR2L, W, A             ; the answer begins a page
        rcall   crc_of_answer
        movff   crc_sum_low, POSTINC2
        movff   crc_sum_high, POSTINC2
        movff   FSR2L, counter
        call    bulk_answer
        goto    bulk_listen

crc_of_answer:
        lfsr    0, ANSWER_PACKET
; CRC of W bytes from FSR0 on, which ends behind them.
crc_block:
        movwf   counter, A
        setf    crc_sum_low, A
        setf    crc_sum_high, A
crc_more:
        movf    POSTINC0, W, A
        call    crc_add
        decfsz  counter, F, A
        bra     crc_more
        return

; Z set when length and CRC of the request are right.
request_whole:
        movlw   SHORTEST - 1
        cpfsgt  asked, A
        bra     outside
        lfsr    0, REQUEST_PACKET
        movf    asked, W, A
        addlw   -2
        rcall   crc_block
        movf    POSTINC0, W, A
        xorwf   crc_sum_low, W, A
        bnz     request_checked
        movf    INDF0, W, A
        xorwf   crc_sum_high, W, A
request_checked:
        return

identify:
        movlw   LOADER_VERSION
        movwf   POSTINC2, A
        movlw   BOARD_NUMBER
        movwf   POSTINC2, A
        movlw   LOW PROGRAM_BEGIN
        movwf   POSTINC2, A
        movlw   HIGH PROGRAM_BEGIN
        movwf   POSTINC2, A
        movlw   LOW PROGRAM_END
        movwf   POSTINC2, A
        movlw   HIGH PROGRAM_END
        movwf   POSTINC2, A
        movff   whole, POSTINC2
        bra     answer

go:
        call    loader_check
        movlw   NOT_WHOLE
        btfss   whole, 0, A
        bra     refused
        bsf     notes, GOING, A
        bra     answer

read:
        rcall   point
        bnz     misplaced
        movlw   ROW
        movwf   counter, A
read_more:
        tblrd*+
        movff   TABLAT, POSTINC2
        decfsz  counter, F, A
        bra     read_more
        bra     answer
misplaced:
        movlw   WRONG_PLACE
        bra     refused

write:
        movlw   SHORTEST + ROW
        cpfseq  asked, A
        bra     damaged
        rcall   point
        bnz     misplaced
        clrf    whole, A
        movf    PLACE_LOW, W, B         ; inside the first block?
        andlw   0xC0
        bnz     not_first
        movlw   HIGH PROGRAM_BEGIN
        xorwf   PLACE_HIGH, W, B
        bz      first
; A program of which a part is new must not be taken for whole.
not_first:
        movlw   HIGH PROGRAM_SEALED
        movwf   TBLPTRH, A
        movlw   LOW PROGRAM_SEALED + 1
        movwf   TBLPTRL, A
        tblrd*
        movlw   ERASED
        xorwf   TABLAT, W, A
        movlw   ERASE_BLOCK
        btfss   STATUS, Z, A
        rcall   change
        rcall   point
first:
        movf    PLACE_LOW, W, B
        andlw   0x3F
        movlw   ERASE_BLOCK
        btfsc   STATUS, Z, A
        rcall   change
        rcall   row_of_request
fill_row:
        movff   POSTINC0, TABLAT
        tblwt*+
        decfsz  counter, F, A
        bra     fill_row
        tblrd*-                         ; back into the row
        movlw   WRITE_ROW
        rcall   change
        rcall   point
        rcall   row_of_request
compare:
        tblrd*+
        movf    POSTINC0, W, A
        xorwf   TABLAT, W, A
        bnz     not_kept
        decfsz  counter, F, A
        bra     compare
        bra     answer
not_kept:
        movlw   NOT_KEPT
        bra     refused

row_of_request:
        lfsr    0, REQUEST_PACKET + 3
        movlw   ROW
        movwf   counter, A
        return

; TBLPTR to the place in the request; Z set when it is a row of the program or
; of what follows it, never of this loader.
point:
        movff   REQUEST_PACKET + 1, TBLPTRL
        movff   REQUEST_PACKET + 2, TBLPTRH
        movlw   HIGH PROGRAM_BEGIN - 1
        cpfsgt  PLACE_HIGH, B
        bra     outside
        movf    PLACE_LOW, W, B
        andlw   ROW - 1
        btfsc   PLACE_HIGH, 7, B
outside:
        movlw   ERASED                  ; not 0
        andlw   0xFF
        return

; Erases the block or writes the row at TBLPTR; the processor stands still
; for 2 ms.
change:
        movwf   EECON1, A
        movlw   0x55
        movwf   EECON2, A
        movlw   0xAA
        movwf   EECON2, A
        bsf     EECON1, WR, A
        nop
        clrf    EECON1, A
        clrwdt
        return
        end
