"""Player input: devices and their bindings, the input of one step, and dragging with the mouse."""
