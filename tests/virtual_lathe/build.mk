# SPDX-License-Identifier: Apache-2.0
# Builds the virtual lathe's shared library; included by the top Makefile.
# Needs gpsim-dev and libglib2.0-dev.

VIRTUAL_LATHE_DIR := tests/virtual_lathe/native
VIRTUAL_LATHE_SO := build/virtual_lathe/libvirtual_lathe.so
VIRTUAL_LATHE_SRC := $(wildcard $(VIRTUAL_LATHE_DIR)/*.cc)
VIRTUAL_LATHE_OBJ := $(VIRTUAL_LATHE_SRC:$(VIRTUAL_LATHE_DIR)/%.cc=build/virtual_lathe/%.o)
# gpsim's headers are system headers: our warnings do not apply to them.
# Not ":=": pkg-config may only be there once setup has run.
VIRTUAL_LATHE_CXXFLAGS = -std=c++17 -O2 -fPIC -Wall -Wextra -Werror \
	$(subst -I,-isystem ,$(shell pkg-config --cflags glib-2.0 2>/dev/null))

.PHONY: virtual-lathe-library
virtual-lathe-library: $(VIRTUAL_LATHE_SO)

build/virtual_lathe/%.o: $(VIRTUAL_LATHE_DIR)/%.cc \
		$(wildcard $(VIRTUAL_LATHE_DIR)/*.hh $(VIRTUAL_LATHE_DIR)/*.h)
	@mkdir -p $(@D)
	$(CXX) $(VIRTUAL_LATHE_CXXFLAGS) -c $< -o $@

$(VIRTUAL_LATHE_SO): $(VIRTUAL_LATHE_OBJ)
	$(CXX) -shared $^ -lgpsim -lgpsim_eXdbm \
		$(shell pkg-config --libs glib-2.0 2>/dev/null) -o $@
