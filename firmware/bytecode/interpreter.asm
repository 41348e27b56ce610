; Interpreter of the byte code that modules in no hurry are compiled to.
; SPDX-License-Identifier: Apache-2.0
;
; firmware/toolchain/compile_bytecode.py writes the byte code and the tables
; that are extern here; README.md tells why.
;
; a          the accumulator
; PRODH:L    the right side of an operation; after a comparison PRODH has the
;            flags of A - right, Z of all 16 bits
; TBLPTR     next byte of byte code; upper byte 0
; FSR1       the software stack: values pushed, arguments of native functions,
;            return addresses (high byte on top; 0xFF = back to native code)
; resume_at  while an operand comes from the table of pairs, or a native
;            function runs: where the byte code goes on; else high byte 0xFF
;
; An operation takes 25 to 45 cycles. Main loop only.

        list    p=18f4550
        include <p18f4550.inc>
        radix   dec

        extern  byte_code               ; functions, offset 0
        extern  byte_pairs              ; operations of two bytes used often
        extern  byte_natives            ; addresses of native functions

        global  byte_enter

        extern  byte_first_pair         ; address = first operation from there

; The numbers below are those of bytecode_operations.py, which are places in
; the table below.
FIRST_MEMORY    equ     55
FIRST_RARE      equ     FIRST_MEMORY    ; memory operations have a table
FIRST_CALL      equ     FIRST_MEMORY + 56

interpreter_data        udata_acs
resume_at       res     2
a               res     2

interpreter_code        code

; From a stub: W, PRODL = address of the function. Returns its A in PRODL, W.
byte_enter:
        movff   resume_at, POSTDEC1
        movff   resume_at + 1, POSTDEC1
        setf    POSTDEC1, ACCESS
        setf    resume_at + 1, ACCESS
        movwf   TBLPTRH, ACCESS
        movff   PRODL, TBLPTRL
        bra     next
leave:
        movff   a + 1, PRODL
        movf    a, W, ACCESS
        movff   PREINC1, resume_at + 1
        movff   PREINC1, resume_at
        return

op_ret1:
        clrf    a + 1, ACCESS
        movlw   1
        movwf   a, ACCESS
        bra     op_ret
op_retk:
        rcall   op_ldk_value
        bra     op_ret
op_ret0:
        clrf    a + 1, ACCESS
        clrf    a, ACCESS
op_ret:
        movf    PREINC1, W, ACCESS
        bn      leave
        movwf   TBLPTRH, ACCESS
        movff   PREINC1, TBLPTRL
        bra     next

; Near the branches that lead here: those reach 128 instructions.
call_function:                          ; W = bits 8 to 12 of the offset
        movwf   PRODL, ACCESS
        tblrd   *+                      ; as operand does, for speed
        btfss   resume_at + 1, 7, ACCESS
        rcall   to_resume
        movf    TABLAT, W, ACCESS
        movff   TBLPTRL, POSTDEC1
        movff   TBLPTRH, POSTDEC1
        addlw   LOW(byte_code)
        movwf   TBLPTRL, ACCESS
        movlw   HIGH(byte_code)
        addwfc  PRODL, W, ACCESS
        movwf   TBLPTRH, ACCESS
        bra     next

memory:                                 ; W = 8 * operation + bits 8 to 10
        movwf   FSR0H, ACCESS
        rrncf   WREG, W, ACCESS
        rrncf   WREG, W, ACCESS
        andlw   0x0E                    ; 2 * operation
        addlw   LOW(memory_operations)
        movwf   PRODL, ACCESS
        movlw   HIGH(memory_operations)
        btfsc   STATUS, C, ACCESS
        addlw   1
        movwf   PCLATH, ACCESS
        movlw   7
        andwf   FSR0H, F, ACCESS
        tblrd   *+                      ; as operand does, for speed
        btfss   resume_at + 1, 7, ACCESS
        rcall   to_resume
        movff   TABLAT, FSR0L
        movf    PRODL, W, ACCESS
        movwf   PCL, ACCESS
memory_operations:
        bra     op_ld8
        bra     op_ld16
        bra     op_st8
        bra     op_st16
        bra     op_add16
        bra     op_sub16
        bra     op_cmp16

; An operation of two bytes from the table: its second byte is taken there, by
; operand, which then leads back.
pair:                                   ; W = number of the pair
        movff   TBLPTRL, resume_at
        movff   TBLPTRH, resume_at + 1
        rlncf   WREG, W, ACCESS
        addlw   LOW(byte_pairs)
        movwf   TBLPTRL, ACCESS
        movlw   HIGH(byte_pairs)
        movwf   TBLPTRH, ACCESS
        btfsc   STATUS, C, ACCESS
        incf    TBLPTRH, F, ACCESS
        tblrd   *+
        bra     execute

op_ld1:
        movlw   1
        bra     byte_result
op_ld0:
        movlw   0
byte_result:                            ; A = W
        movwf   a, ACCESS
        clrf    a + 1, ACCESS

next:
        tblrd   *+
        movlw   LOW(byte_first_pair)
        subwf   TABLAT, W, ACCESS
        bc      pair
execute:                                ; TABLAT = operation
        movf    TABLAT, W, ACCESS
        addlw   -FIRST_CALL
        bc      call_function
        addlw   FIRST_CALL - FIRST_MEMORY
        bc      memory
        addlw   FIRST_MEMORY
jump:                                   ; W = number in the table
        rlncf   WREG, W, ACCESS
        addlw   LOW(operations)
        movwf   PRODL, ACCESS
        movlw   HIGH(operations)
        movwf   PCLATH, ACCESS
        btfsc   STATUS, C, ACCESS
        incf    PCLATH, F, ACCESS
        movf    PRODL, W, ACCESS
        movwf   PCL, ACCESS
operations:
        bra     op_ret
        bra     op_ret0
        bra     op_ret1
        bra     op_ld0
        bra     op_ld1
        bra     op_inc
        bra     op_dec
        bra     op_push
        bra     op_push8
        bra     op_subs
        bra     op_cmps
        bra     op_neg
        bra     op_low
        bra     op_ldi8
        bra     op_clrwdt
        bra     op_drop1
        bra     op_drop2
        bra     op_drop4
        bra     op_shl
        bra     op_shr
        bra     op_ldk
        bra     op_ldkn
        bra     op_addk
        bra     op_addkn
        bra     op_cmpk
        bra     op_retk
        bra     op_andk
        bra     op_ork
        bra     op_ldkw
        bra     op_addkw
        bra     op_cmpkw
        bra     op_case
        bra     op_jmp
        bra     op_jz
        bra     op_jnz
        bra     op_jeq
        bra     op_jne
        bra     op_jlt
        bra     op_jge
        bra     op_jgt
        bra     op_jle
        bra     op_jltu
        bra     op_jgeu
        bra     op_jgtu
        bra     op_jleu
        bra     op_ljmp
        bra     op_native8
        bra     op_native16
        bra     op_ldt8
        bra     op_add8
        bra     op_cmp8
        bra     op_ldx8
        bra     op_ldx16
        bra     op_stx8
        bra     op_rare
rare_operations:
        bra     op_adds
        bra     op_ands
        bra     op_ors
        bra     op_xors
        bra     op_com
        bra     op_ldi16
        bra     op_sti8
        bra     op_sti16
        bra     op_drop3
        bra     op_sar
        bra     op_xork
        bra     op_andkw
        bra     op_ldt16
        bra     op_stx16
        bra     op_sub8
        bra     op_and8
        bra     op_or8
        bra     op_xor8
        bra     op_and16
        bra     op_or16

; Operations that are seldom used are one byte longer.
op_rare:
        rcall   operand
        addlw   FIRST_RARE
        bra     jump

; W, TABLAT = next byte of an operation.
operand:
        tblrd   *+
        btfss   resume_at + 1, 7, ACCESS
        rcall   to_resume
        movf    TABLAT, W, ACCESS
        return

; TABLAT = next byte of a jump; W and STATUS stay.
distance:
        tblrd   *+
        btfss   resume_at + 1, 7, ACCESS
        bra     to_resume
        return

op_native8:
        rcall   native
        bra     byte_result
op_native16:
        rcall   native
        movwf   a, ACCESS
        movff   PRODL, a + 1
        bra     next
native:
        rcall   operand
        movff   TBLPTRL, resume_at
        movff   TBLPTRH, resume_at + 1
        rlncf   WREG, W, ACCESS
        addlw   LOW(byte_natives)
        movwf   TBLPTRL, ACCESS
        movlw   HIGH(byte_natives)
        movwf   TBLPTRH, ACCESS
        btfsc   STATUS, C, ACCESS
        incf    TBLPTRH, F, ACCESS
        rcall   native_call
to_resume:
        movff   resume_at, TBLPTRL
        movff   resume_at + 1, TBLPTRH
        setf    resume_at + 1, ACCESS
        return
native_call:
        tblrd   *+
        movff   TABLAT, PRODL
        tblrd   *+
        movff   TABLAT, PCLATH
        movf    PRODL, W, ACCESS
        movwf   PCL, ACCESS

        include "arithmetic.inc"
        include "variables.inc"

        end
