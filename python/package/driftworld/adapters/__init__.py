"""Adapters for other libraries, one file for each library, which is imported only when its adapter is used.

Libraries that take Gymnasium's own environments and vector environments (CleanRL, TorchRL, RLlib) need no adapter.
"""
