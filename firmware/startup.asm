; Head of the program, and its entry behind the boot loader: remembers why the
; chip was reset, clears RAM, sets the software stack, runs main.
; SPDX-License-Identifier: Apache-2.0
;
; SDCC expects FSR1 and FSR2 at the end of the stack and TBLPTRU = 0. There is
; no copying of initialised variables: repair_assembly.py refuses them.
; Clearing 2 KB takes 0.5 ms.
;
; The loader (loader/README.md) begins a program only when the CRC at the head
; fits everything from behind it to its end. seal_program.py works out both
; after a first link; a second one takes them from seal.inc.

        include <p18f4550.inc>
        include "seal.inc"              ; SEAL_CRC, SEAL_END, versions
        radix   dec

        global  _loader_enter

        extern  _main
        extern  _stack_end
        extern  _reset_rcon, _reset_stkptr

program_head    code    0x000800
        dw      SEAL_CRC, SEAL_END
        goto    entry
        db      "Tornillo"
        db      BOARD_NUMBER, VERSION_MAJOR, VERSION_MINOR, VERSION_PATCH
        db      PROTOCOL_VERSION, 0xFF

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

; void loader_enter(void): into the boot loader. The USB leaves the bus, and
; every pin lets go. A byte on its way into the EEPROM is waited for.
_loader_enter:
        btfsc   EECON1, WR, A
        bra     _loader_enter
        clrf    INTCON, A
        clrf    UCON, A
        movlw   'T'
        movwf   0x00, A                 ; keys of loader/loader.inc
        movlw   'L'
        movwf   0x01, A
        reset
        end
