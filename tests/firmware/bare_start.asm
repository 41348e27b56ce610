; Reset entry of the small programs that tests compile: no boot loader, no head.
; SPDX-License-Identifier: Apache-2.0

        include <p18f4550.inc>
        radix   dec

        extern  _main
        extern  _stack_end

vector_reset code 0x000000
        goto    entry

code_startup code
entry:
        lfsr    0, 0
clear:
        clrf    POSTINC0, A
        movlw   0x08
        cpfseq  FSR0H, A
        bra     clear
        clrf    TBLPTRU, A
        lfsr    1, _stack_end
        lfsr    2, _stack_end
        goto    _main
        end
