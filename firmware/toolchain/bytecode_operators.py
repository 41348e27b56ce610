# SPDX-License-Identifier: Apache-2.0
"""Operators of C, and what they are called in byte code."""

SWAPPED = {"<": ">", ">": "<", "<=": ">=", ">=": "<=", "==": "==", "!=": "!="}
INVERTED = {"<": ">=", ">=": "<", ">": "<=", "<=": ">", "==": "!=", "!=": "=="}
SIGNED_JUMP = {"<": "jlt", ">=": "jge", ">": "jgt", "<=": "jle", "==": "jeq", "!=": "jne"}
UNSIGNED_JUMP = SIGNED_JUMP | {"<": "jltu", ">=": "jgeu", ">": "jgtu", "<=": "jleu"}
SIMPLE_OPERATIONS = {"+": "add", "-": "sub", "&": "and", "|": "or", "^": "xor"}
COMMUTATIVE = {"+", "&", "|", "^", "*"}
FROM_RAM = {"add8", "add16", "sub8", "sub16", "and8", "and16", "or8", "or16", "xor8"}
LIBRARY = {"*": "_mulint", "/": "_divuint", "%": "_moduint"}
